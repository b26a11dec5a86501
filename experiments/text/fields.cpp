#include "experiments/text/fields.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace beamid::experiments {
namespace {

constexpr std::string_view blanks = " \t\v\f";

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return text.substr(0, 0);
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string_view unquoted(std::string_view text) {
  const bool quoted =
      text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.front() == text.back();
  return quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

char separator_of(std::string_view line) {
  for (const char candidate : {'\t', ';', ','})
    if (line.find(candidate) != std::string_view::npos) return candidate;
  return ' ';
}

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  const bool blank = separator == ' ';
  if (blank) line = trimmed(line);
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end =
        std::min(blank ? line.find_first_of(blanks, begin) : line.find(separator, begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    begin = blank ? std::min(line.find_first_not_of(blanks, end), line.size() + 1) : end + 1;
  }
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
}

ParsedNumber parse_number(std::string_view field) {
  if (field.starts_with('+') && !field.starts_with("+-")) field.remove_prefix(1);
  ParsedNumber parsed;
  const char* const end = field.data() + field.size();
  const auto result = std::from_chars(field.data(), end, parsed.value);
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

bool holds_number(const std::vector<std::string_view>& fields, char decimal) {
  return std::any_of(fields.begin(), fields.end(),
                     [&](std::string_view field) { return parse_number(field, decimal).number; });
}

bool all_numbers(const std::vector<std::string_view>& fields, char decimal) {
  return !fields.empty() && std::all_of(fields.begin(), fields.end(), [&](std::string_view field) {
    return parse_number(field, decimal).number;
  });
}

}  // namespace beamid::experiments
