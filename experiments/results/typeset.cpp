#include "experiments/results/typeset.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace beamid::experiments {
namespace {

constexpr std::array<std::string_view, 10> raised_digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

bool letter_or_digit(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

bool digit(char c) {
  return c >= '0' && c <= '9';
}

/// "^2", "^-8" at `at`: their length, 0 where there is none.
std::size_t power_at(std::string_view text, std::size_t at) {
  if (text[at] != '^' || at == 0 || !letter_or_digit(text[at - 1])) return 0;
  std::size_t end = at + 1;
  if (end < text.size() && text[end] == '-') ++end;
  const std::size_t first = end;
  while (end < text.size() && digit(text[end])) ++end;
  return end > first ? end - at : 0;
}

/// Whether a unit may begin at `at`: behind "[", "/", "(", a number or another unit with a blank.
bool unit_begins(std::string_view text, std::size_t at) {
  if (at == 0) return false;
  const char before = text[at - 1];
  if (before == '[' || before == '/') return true;
  if (before == '(') return at + 2 < text.size() && text[at] == 'm' && text[at + 1] == '/';
  if (before != ' ' || at < 2) return false;
  if (digit(text[at - 2])) return true;
  constexpr std::array<std::string_view, 5> units{"N", "kg", "m", "s", "g"};
  return std::any_of(units.begin(), units.end(), [&](std::string_view unit) {
    return text.substr(0, at - 1).ends_with(unit) &&
           (at - 1 == unit.size() || !letter_or_digit(text[at - 2 - unit.size()]));
  });
}

/// "m2", "s2", "m4" of a unit at `at`: the length of its letters, 0 where there is none.
std::size_t raised_unit_at(std::string_view text, std::size_t at) {
  if (!unit_begins(text, at)) return 0;
  for (const std::string_view unit : {"mm", "m", "s"}) {
    const std::size_t end = at + unit.size();
    if (text.substr(at).starts_with(unit) && end < text.size() && text[end] >= '2' && text[end] <= '4' &&
        (end + 1 == text.size() || !letter_or_digit(text[end + 1])))
      return unit.size();
  }
  return 0;
}

}  // namespace

std::string typeset(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i).starts_with(" +- ")) {  // with blanks where no line breaks
      result += "\u00a0±\u00a0";
      i += 4;
    } else if (text.substr(i).starts_with("+-")) {
      result += "±";
      i += 2;
    } else if (text.substr(i).starts_with("chi^2") && (i == 0 || !letter_or_digit(text[i - 1]))) {
      result += "χ²";
      i += 5;
    } else if (const std::size_t power = power_at(text, i); power > 0) {
      for (const char c : text.substr(i + 1, power - 1)) result += c == '-' ? "⁻" : raised_digits[c - '0'];
      i += power;
    } else if (const std::size_t unit = raised_unit_at(text, i); unit > 0) {
      result.append(text.substr(i, unit)).append(raised_digits[text[i + unit] - '0']);
      i += unit + 1;
    } else {
      result += text[i++];
    }
  }
  return result;
}

}  // namespace beamid::experiments
