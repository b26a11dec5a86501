#include "apps/suggestion.hpp"

#include <sstream>

#include "experiments/config/known_names.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::apps {
namespace {

/// "a, b, c" taken apart.
std::vector<std::string> listed(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(", ", at), text.size());
    names.push_back(text.substr(at, end - at));
    at = end + 2;
  }
  return names;
}

// is the text "clamped-fre"; expected one of clamped-free, ...
std::string suggested_text(const std::string& line) {
  const std::string is = "is the text \"", list = "\"; expected one of ";
  const std::size_t from = line.find(is), to = line.find(list, from);
  if (from == std::string::npos || to == std::string::npos) return line;
  const std::size_t word = from + is.size();
  const std::string hint = suggestion(line.substr(word, to - word), listed(line.substr(to + list.size())));
  return hint.empty() ? line : line.substr(0, to + 1) + hint;
}

std::string suggested(const std::string& line) {
  constexpr const char* before = "'; known: ";
  const std::size_t unknown = line.rfind("unknown "), at = line.find(before, unknown);
  if (unknown == std::string::npos || at == std::string::npos) return suggested_text(line);
  const std::size_t quote = line.find('\'', unknown);
  if (quote >= at) return line;
  const std::vector<std::string> known = listed(line.substr(at + std::char_traits<char>::length(before)));
  return line.substr(0, at + 3) + experiments::known_names(line.substr(quote + 1, at - quote - 1), known);
}

}  // namespace

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const auto meant = experiments::nearest(word, known);
  return meant ? "; did you mean '" + *meant + "'?" : "";
}

std::string with_suggestions(const std::string& message) {
  std::istringstream lines(message);
  std::string result;
  for (std::string line; std::getline(lines, line);) result += (result.empty() ? "" : "\n") + suggested(line);
  return result;
}

}  // namespace beamid::apps
