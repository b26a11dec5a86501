#include "experiments/text/fields.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>

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

/// Overrides, embeddings and isolates: they would turn round what stands behind the text, too.
bool turns_direction(char32_t code) {
  return (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
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
    } else if (!is_control(letter.code) && !turns_direction(letter.code)) {
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

namespace {

constexpr std::string_view blanks = " \t\v\f";

/// Of a field in quotes at the beginning of `rest`: how long it is with them; 0: it is none.
std::size_t quoted_length(std::string_view rest, char separator) {
  if (!rest.starts_with('"')) return 0;
  for (std::size_t end = 1; (end = rest.find('"', end)) != std::string_view::npos;) {
    if (++end < rest.size() && rest[end] == '"') {
      ++end;
      continue;
    }
    const std::size_t next =
        separator == ' ' || separator == '\t' ? end : rest.find_first_not_of(blanks, end);
    const bool last = next >= rest.size();
    return last || (separator == ' ' ? blanks.find(rest[next]) != blanks.npos : rest[next] == separator) ? end
                                                                                                         : 0;
  }
  return 0;
}

}  // namespace

std::string_view take_line(std::string_view& rest) {
  const auto ends = [](char letter) { return letter == '\n' || letter == '\r'; };
  const auto end = static_cast<std::size_t>(std::ranges::find_if(rest, ends) - rest.begin());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(rest.size(), end + (rest.substr(end).starts_with("\r\n") ? 2 : 1)));
  return line;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return text.substr(0, 0);
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string field_text(std::string_view field) {
  if (field.size() < 2 || field.front() != '"' || field.back() != '"') return std::string(field);
  std::string inner(field.substr(1, field.size() - 2));
  for (std::size_t at = 0; (at = inner.find("\"\"", at)) != std::string::npos; ++at) inner.erase(at, 1);
  return inner;
}

std::string unquoted(std::string_view field) {
  const bool single = field.size() >= 2 && field.front() == '\'' && field.back() == '\'';
  return std::string(trimmed(single ? std::string(field.substr(1, field.size() - 2)) : field_text(field)));
}

char separator_of(std::string_view line) {
  for (const char candidate : {'\t', ';', '|', ','})
    if (line.find(candidate) != std::string_view::npos) return candidate;
  return ' ';
}

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields,
                  bool empty_ends) {
  fields.clear();
  const bool blank = separator == ' ';
  if (blank) line = trimmed(line);
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t first = std::min(line.find_first_not_of(' ', begin), line.size()),
                      quoted = quoted_length(line.substr(first), separator),
                      from = quoted > 0 ? first + quoted : begin;
    const std::size_t end =
        std::min(blank ? line.find_first_of(blanks, from) : line.find(separator, from), line.size());
    std::string_view field = trimmed(line.substr(begin, end - begin));
    if (const auto inner = field.substr(quoted > 0, field.size() - 2);
        quoted > 0 && inner.find('"') == inner.npos)
      field = inner;
    fields.push_back(field);
    begin = blank ? std::min(line.find_first_not_of(blanks, end), line.size() + 1) : end + 1;
  }
  while (!empty_ends && !fields.empty() && fields.back().empty()) fields.pop_back();
}

std::string toml_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char letter : clean_text(text))
    quoted += (letter == '"' || letter == '\\' ? "\\" : "") + std::string(1, letter);
  return quoted + '"';
}

std::string csv_field(std::string_view raw) {
  const std::string text = clean_lines(raw);
  const bool plain = text.find_first_of(",\"\n") == std::string::npos && trimmed(text).size() == text.size();
  if (plain) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

std::string csv_field(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

ParsedNumber parse_number(std::string_view field) {
  if (field.starts_with('+') && !field.starts_with("+-")) field.remove_prefix(1);
  ParsedNumber parsed;
  const char* const end = field.data() + field.size();
  const auto result = std::from_chars(field.data(), end, parsed.value);
  if (result.ptr != end && result.ptr != field.data() && (*result.ptr == 'D' || *result.ptr == 'd') &&
      field.size() < 64) {
    std::string with_e(field);
    with_e[static_cast<std::size_t>(result.ptr - field.data())] = 'E';
    return parse_number(with_e);
  }
  parsed.number = result.ptr == end && result.ec != std::errc::invalid_argument;
  parsed.finite = parsed.number && result.ec == std::errc() && std::isfinite(parsed.value);
  return parsed;
}

ParsedNumber parse_number(std::string_view field, char decimal) {
  if (decimal == '.') return parse_number(field);
  constexpr std::size_t longest = 64;
  if (field.size() > longest || field.find('.') != std::string_view::npos) return {};
  char pointed[longest];
  std::replace_copy(field.begin(), field.end(), pointed, decimal, '.');
  return parse_number(std::string_view(pointed, field.size()));
}

bool says_missing(std::string_view field) {
  if (field.empty()) return true;
  std::string text = unquoted(field);
  for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  static const std::set<std::string> nothing{"",         "nan", "na", "n/a", "#n/a", "null", "none",
                                             "overflow", "ovf", "ol", "-",   "--",   "∞",    "-∞"};
  return nothing.contains(text);
}

bool holds_number(const std::vector<std::string_view>& fields, char decimal) {
  return std::any_of(fields.begin(), fields.end(),
                     [&](std::string_view field) { return parse_number(field, decimal).number; });
}

bool all_numbers(const std::vector<std::string_view>& fields, char decimal) {
  return !fields.empty() && std::all_of(fields.begin(), fields.end(), [&](std::string_view field) {
    return parse_number(field, decimal).number;
  });
}

std::string column_key(const std::string& name, const std::string& unit) {
  std::string key = name;
  if (!unit.empty()) key += "_";
  for (const char letter : unit) {
    if (letter == '/')
      key += "_per_";
    else
      key += letter == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return key;
}

std::size_t label_length(std::string_view field) {
  const std::size_t sign = field.find_first_of(":=");
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (sign == field.npos || sign == 0 || !letter(field.front())) return 0;
  return parse_number(trimmed(field.substr(sign + 1))).number ? sign + 1 : 0;
}

std::vector<std::string_view> parted_by_blanks(std::string_view line) {
  std::vector<std::string_view> words;
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const std::size_t end = std::min(line.find("  "), line.size());
    words.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(end);
  }
  return words;
}

}  // namespace beamid::experiments
