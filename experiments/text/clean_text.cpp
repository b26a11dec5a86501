#include "experiments/text/clean_text.hpp"

#include <algorithm>

namespace beamid::experiments {
namespace {

struct Letter {
  char32_t code;
  std::size_t bytes;
  bool valid;  ///< a UTF-8 sequence; else one byte of ISO 8859-1
};

Letter first_letter(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const Letter single{byte(0), 1, byte(0) < 0x80};
  const std::size_t length = byte(0) < 0xC2 ? 1 : byte(0) < 0xE0 ? 2 : byte(0) < 0xF0 ? 3 : 4;
  if (length == 1 || byte(0) > 0xF4 || length > text.size()) return single;
  char32_t code = byte(0) & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return single;
    code = code << 6 | (byte(i) & 0x3F);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return overlong || surrogate || code > 0x10FFFF ? single : Letter{code, length, true};
}

bool is_control(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code <= 0x9F) || code == 0xFFFE || code == 0xFFFF;
}

std::string clean(std::string_view text, bool lines) {
  std::string result;
  while (!text.empty()) {
    const Letter letter = first_letter(text);
    if (letter.code == '\n' && lines) {
      result += '\n';
    } else if (letter.code == '\t' || letter.code == '\n') {
      result += ' ';
    } else if (letter.code == '\r') {
      if (!lines && !text.substr(1).starts_with('\n')) result += ' ';
    } else if (!is_control(letter.code)) {
      if (letter.valid)
        result += text.substr(0, letter.bytes);
      else
        (result += static_cast<char>(0xC0 | letter.code >> 6)) +=
            static_cast<char>(0x80 | (letter.code & 0x3F));
    }
    text.remove_prefix(letter.bytes);
  }
  return result;
}

}  // namespace

std::string clean_text(std::string_view text) {
  return clean(text, false);
}

std::string clean_lines(std::string_view text) {
  return clean(text, true);
}

std::size_t find_control(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Letter letter = first_letter(text.substr(at));
    if (is_control(letter.code)) return at;
    at += letter.bytes;
  }
  return std::string_view::npos;
}

}  // namespace beamid::experiments
