#include "experiments/results/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
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

/// Words of verdicts. They stand in capitals; what stands in capitals before them, as in THE RECORDS
/// DISAGREE, belongs to them.
constexpr std::array verdicts{"DIVERGED", "CONTRADICTED", "DISAGREE", "ALIASED",  "WRONG",       "WARNING",
                              "SETTLED",  "DETERMINED",   "RELY",     "diverged", "contradicted"};

bool in_capitals(const std::string& line, std::size_t from, std::size_t to) {
  return from < to &&
         std::all_of(line.begin() + static_cast<long>(from), line.begin() + static_cast<long>(to),
                     [](unsigned char c) { return std::isupper(c); });
}

bool is_letter(const std::string& line, std::size_t at) {
  return at < line.size() && std::isalnum(static_cast<unsigned char>(line[at]));
}

}  // namespace

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
}

std::string emphasised(const std::string& line, const Page& page) {
  if (!page.colour) return line;
  for (const std::string verdict : verdicts) {
    const std::size_t at = line.find(verdict), end = at + verdict.size();
    if (at == std::string::npos || is_letter(line, end) || (at > 0 && is_letter(line, at - 1))) continue;
    std::size_t start = at;
    while (start > 1 && line[start - 1] == ' ') {
      const std::size_t blank = line.rfind(' ', start - 2), word = blank == std::string::npos ? 0 : blank + 1;
      if (!in_capitals(line, word, start - 1)) break;
      start = word;
    }
    return line.substr(0, start) + "\033[1;31m" + line.substr(start, end - start) + "\033[0m" +
           line.substr(end);
  }
  return line;
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines;
  std::istringstream stream{std::string(text)};
  for (std::string line; std::getline(stream, line);) wrap_line(line, width, lines);
  return lines;
}

}  // namespace beamid::experiments
