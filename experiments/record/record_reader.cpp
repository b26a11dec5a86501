#include "experiments/record/record_reader.hpp"

#include <fstream>

#include "experiments/text/clean_text.hpp"
#include "experiments/text/text_file.hpp"

namespace beamid::experiments {
namespace {

constexpr const char* fallback = "delimited_text";

}  // namespace

RecordReaderRegistry& record_reader_registry() {
  static RecordReaderRegistry registry("reader");
  return registry;
}

std::string reader_of(const std::filesystem::path& file, const RecordFormat& format) {
  if (!format.reader.empty()) return record_reader_registry().find(format.reader).name;
  if (format.header_lines > 0 || format.separator != '\0') return fallback;
  std::ifstream stream = open_input(file, "a record of numbers in columns");
  std::string beginning(1024, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  for (const auto& [name, entry] : record_reader_registry().entries())
    if (name != fallback && record_reader_registry().make(name, {})->recognises(beginning)) return name;
  return fallback;
}

RecordTable read_table(const std::filesystem::path& file, const RecordFormat& format) {
  RecordTable table = record_reader_registry().make(reader_of(file, format), {})->read(file, format);
  for (auto* texts : {&table.names, &table.units, &table.remarks, &table.warnings})
    for (std::string& text : *texts) text = clean_text(text);
  return table;
}

}  // namespace beamid::experiments
