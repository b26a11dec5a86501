#include "experiments/text/text_file.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>
#include <vector>

#include "experiments/text/input_error.hpp"
#include "experiments/text/memory_need.hpp"

namespace beamid::experiments {
namespace {

bool is_binary(char byte) {
  return byte >= 0 && byte < '\t';
}

/// Refuses what memory does not hold as bytes and, at 8 bytes each, as the numbers that they may be. Of a
/// pipe no size is known before its end.
void require_fitting(const std::filesystem::path& file, double bytes) {
  try {
    require_memory(bytes, "bytes of a file", 8.0);
  } catch (const std::invalid_argument& error) {
    throw InputError({file.string()}, error.what());
  }
}

/// UTF-16 in UTF-8: text of spreadsheets and of instruments' software. @param high whether the first byte is
/// the higher
std::string from_utf16(const std::string& bytes, bool high) {
  std::string text;
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]),
               second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<unsigned>(high ? first << 8 | second : second << 8 | first);
  };
  for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
    unsigned code = unit(at);
    if (code >= 0xD800 && code < 0xDC00 && at + 3 < bytes.size()) {
      code = 0x10000 + ((code - 0xD800) << 10) + (unit(at + 2) - 0xDC00);
      at += 2;
    }
    if (code < 0x80) {
      text += static_cast<char>(code);
      continue;
    }
    const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    text += static_cast<char>((more == 1 ? 0xC0 : more == 2 ? 0xE0 : 0xF0) | (code >> (6 * more) & 0x1F));
    for (int k = more - 1; k >= 0; --k) text += static_cast<char>(0x80 | (code >> (6 * k) & 0x3F));
  }
  return text;
}

}  // namespace

std::ifstream open_input(const std::filesystem::path& file, const std::string& expected) {
  const Place place{file.string(), 0, 0};
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(file, failure);
  if (!std::filesystem::exists(status)) throw InputError(place, "no such file; expected " + expected);
  if (std::filesystem::is_directory(status)) throw InputError(place, "a directory; expected " + expected);
  if (std::filesystem::is_fifo(status))  // a file is read more than once: what it is, then what it holds
    throw InputError(place, "a pipe; expected " + expected + " in a file");
  if (std::filesystem::is_character_file(status)) throw InputError(place, "a device; expected " + expected);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(place, "cannot be opened; expected " + expected + " that may be read");
  return stream;
}

std::string read_bytes(const std::filesystem::path& file, const std::string& expected) {
  std::ifstream stream = open_input(file, expected);
  std::error_code unknown;
  const auto size = std::filesystem::file_size(file, unknown);
  if (!unknown) require_fitting(file, static_cast<double>(size));
  std::string bytes;
  if (!unknown) bytes.reserve(static_cast<std::size_t>(size) + 1);
  for (std::vector<char> part(1 << 16); stream;) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    bytes.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw InputError({file.string()}, "cannot be read to its end; expected " + expected);
  if (bytes.empty()) throw InputError({file.string()}, "an empty file; expected " + expected);
  return bytes;
}

std::size_t count_bytes(const std::filesystem::path& file, const std::string& expected) {
  std::ifstream stream = open_input(file, expected);
  stream.seekg(0, std::ios::end);
  const std::streamoff size = stream.tellg();
  if (!stream || size < 0)
    throw InputError({file.string()}, "cannot be read to its end; expected " + expected);
  if (size == 0) throw InputError({file.string()}, "an empty file; expected " + expected);
  return static_cast<std::size_t>(size);
}

std::string read_text(const std::filesystem::path& file, const std::string& expected) {
  const Place place{file.string(), 0, 0};
  std::string text = read_bytes(file, expected);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    text = from_utf16(text, text.starts_with("\xFE"));
  if (text.empty()) throw InputError(place, "an empty file; expected " + expected);
  if (const auto byte = std::find_if(text.begin(), text.end(), is_binary); byte != text.end()) {
    const auto line = std::count(text.begin(), byte, '\n') + 1;
    const std::size_t before = text.rfind('\n', static_cast<std::size_t>(byte - text.begin()));
    const std::size_t start = before == std::string::npos ? 0 : before + 1;
    throw InputError({place.file, static_cast<std::size_t>(line),
                      static_cast<std::size_t>(byte - text.begin()) - start + 1},
                     "a binary byte (" + std::to_string(static_cast<int>(*byte)) + "); expected " + expected +
                         " in ASCII or UTF-8");
  }
  return text;
}

}  // namespace beamid::experiments
