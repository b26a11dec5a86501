#include "experiments/results/text.hpp"

#include <algorithm>
#include <sstream>

namespace beamid::experiments {
namespace {

void wrap_line(const std::string& line, std::size_t width, std::vector<std::string>& lines) {
  if (width_of(line) <= width) {
    lines.push_back(line);
    return;
  }
  const std::size_t indent = std::min(line.find_first_not_of(' '), width / 2);
  const std::string margin(indent + (line.compare(indent, 2, "- ") == 0 ? 2 : 0), ' ');
  std::istringstream words(line);
  std::string current(indent, ' '), word;
  bool empty = true;
  while (words >> word) {
    if (!empty && width_of(current) + 1 + width_of(word) > width) {
      lines.push_back(current);
      current = margin;
      empty = true;
    }
    current += (empty ? "" : " ") + word;
    empty = false;
  }
  lines.push_back(current);
}

}  // namespace

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines;
  std::istringstream stream{std::string(text)};
  for (std::string line; std::getline(stream, line);) wrap_line(line, width, lines);
  return lines;
}

}  // namespace beamid::experiments
