#include "experiments/input/record_reader.hpp"

#include <fstream>
#include <iterator>
#include <system_error>

namespace beamid::experiments {
namespace {

constexpr const char* fallback = "delimited_text";

std::ifstream open(const std::filesystem::path& file, const std::string& expected) {
  const Place place{file.string(), 0, 0};
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(file, failure);
  if (!std::filesystem::exists(status)) throw InputError(place, "no such file; expected " + expected);
  if (std::filesystem::is_directory(status)) throw InputError(place, "a directory; expected " + expected);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(place, "cannot be opened; expected " + expected + " that may be read");
  return stream;
}

}  // namespace

RecordReaderRegistry& record_reader_registry() {
  static RecordReaderRegistry registry("reader");
  return registry;
}

std::string reader_of(const std::filesystem::path& file, const RecordFormat& format) {
  if (!format.reader.empty()) return record_reader_registry().find(format.reader).name;
  if (format.header_lines > 0 || format.separator != '\0') return fallback;
  std::ifstream stream = open(file, "a record of numbers in columns");
  std::string beginning(1024, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  for (const auto& [name, entry] : record_reader_registry().entries())
    if (name != fallback && record_reader_registry().make(name, {})->recognises(beginning)) return name;
  return fallback;
}

RecordTable read_table(const std::filesystem::path& file, const RecordFormat& format) {
  return record_reader_registry().make(reader_of(file, format), {})->read(file, format);
}

std::string read_bytes(const std::filesystem::path& file, const std::string& expected) {
  std::ifstream stream = open(file, expected);
  std::string bytes(std::istreambuf_iterator<char>(stream), {});
  if (stream.bad()) throw InputError({file.string()}, "cannot be read to its end; expected " + expected);
  if (bytes.empty()) throw InputError({file.string()}, "an empty file; expected " + expected);
  return bytes;
}

}  // namespace beamid::experiments
