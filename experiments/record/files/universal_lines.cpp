#include "experiments/record/files/universal_lines.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

using std::string_view;

void UniversalLines::fail(const std::string& message, std::size_t column) const {
  throw InputError({name_, number_, column}, message);
}

bool UniversalLines::next() {
  if (at_ >= bytes_.size()) return false;
  begin_ = at_;
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  line_ = string_view(bytes_).substr(at_, end - at_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  at_ = end + 1;
  ++number_;
  return true;
}

void UniversalLines::next_of_header(const char* what) {
  if (!next() || trimmed(line_) == "-1") fail(fmt::format("the dataset ends; expected {}", what));
}

bool UniversalLines::next_dataset(int& number) {
  while (next()) {
    if (trimmed(line_) != "-1") continue;
    if (!next()) return false;
    string_view word = trimmed(line_.substr(0, std::min<std::size_t>(6, line_.size())));
    if (word == "-1") {  // an end without a beginning begins the next set
      back();
      continue;
    }
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) number = 0;
    return true;
  }
  return false;
}

void UniversalLines::skip_dataset() {
  while (next())
    if (trimmed(line_) == "-1") return;
}

string_view UniversalLines::field(std::size_t from, std::size_t width) const {
  return from < line_.size() ? trimmed(line_.substr(from, width)) : string_view();
}

long long UniversalLines::whole(std::size_t from, std::size_t width, const char* what) const {
  const string_view text = field(from, width);
  long long value = 0;
  const char* const end = text.data() + text.size();
  if (text.empty()) return 0;
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end)
    fail(fmt::format("'{}'; expected {}, a whole number", text, what), from + 1);
  return value;
}

double UniversalLines::real(std::size_t from, std::size_t width, const char* what) const {
  const string_view text = field(from, width);
  if (text.empty()) return 0.0;
  const ParsedNumber parsed = parse_fortran(text);
  if (!parsed.finite) fail(fmt::format("'{}'; expected {}, a number", text, what), from + 1);
  return parsed.value;
}

ParsedNumber parse_fortran(string_view text) {
  std::string plain(text);
  for (char& letter : plain) letter = letter == 'D' || letter == 'd' ? 'e' : letter;
  return parse_number(plain);
}

}  // namespace beamid::experiments
