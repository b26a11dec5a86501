#include "apps/reference.hpp"

#include <regex>

namespace beamid::apps {
namespace {

// What stands beside the key in its row, "| `key` | reference |"; empty when it has none.
std::string reference_of(const std::string& key) {
  const std::string text = references_text, start = "\n| `" + key + "` | ";
  const std::size_t row = text.find(start);
  if (row == std::string::npos) return "";
  const std::size_t first = row + start.size(), end = text.find(" |\n", first);
  static const std::regex emphasis(R"re(\*([^*]+)\*)re");
  return std::regex_replace(text.substr(first, end - first), emphasis, "$1");
}

}  // namespace

std::vector<std::string> full_references(const std::string& source) {
  static const std::regex citation(R"re(\[([a-z]+[0-9]{4}[a-z]?)((, [^\]]+)?)\])re");
  std::vector<std::string> found;
  for (std::sregex_iterator cited(source.begin(), source.end(), citation), end; cited != end; ++cited) {
    const std::string reference = reference_of((*cited)[1]);
    if (reference.empty()) return {source};
    found.push_back(reference + (*cited)[2].str());
  }
  if (found.empty() && !source.empty()) found.push_back(source);
  return found;
}

}  // namespace beamid::apps
