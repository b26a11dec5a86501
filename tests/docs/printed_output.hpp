// Is a block that a page prints part of what a command printed?
#pragma once

#include <fmt/format.h>

#include "tests/docs/compare_numbers.hpp"

namespace beamid::docs {

/// Lines of a page that follow each other in the output; "..." parts one fragment from the next.
struct Fragment {
  int line;  ///< of the page
  std::vector<std::string> text;
};

inline std::vector<Fragment> fragments(const std::vector<std::string>& block, int line) {
  std::vector<Fragment> found{{line, {}}};
  for (std::size_t i = 0; i < block.size(); ++i)
    if (block[i] == "..." || block[i] == "[...]")
      found.push_back({line + int(i) + 1, {}});
    else
      found.back().text.push_back(block[i]);
  for (Fragment& one : found)
    for (; !one.text.empty() && one.text.front().empty(); ++one.line) one.text.erase(one.text.begin());
  for (Fragment& one : found)
    while (!one.text.empty() && one.text.back().empty()) one.text.pop_back();
  std::erase_if(found, [](const Fragment& one) { return one.text.empty(); });
  return found;
}

/// Where a fragment agrees best with an output.
struct Place {
  std::size_t output = 0, line = 0, same = 0;
};

/// @param digits units of the last digit that a number may differ by
inline bool same_as_printed(const std::string& printed, const std::string& found, double digits) {
  return same_line(printed, found, digits, {0, 0});
}

inline std::size_t lines_that_agree(const std::vector<std::string>& fragment,
                                    const std::vector<std::string>& output, std::size_t from) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < fragment.size() && from + i < output.size(); ++i)
    same += !fragment[i].empty() && same_as_printed(fragment[i], output[from + i], 1);
  return same;
}

/// The best place in the latest outputs; of equals the latest output.
inline Place best_place(const std::vector<std::string>& fragment,
                        const std::vector<std::vector<std::string>>& outputs) {
  Place best;
  for (std::size_t o = 0; o < outputs.size(); ++o)
    for (std::size_t line = 0; line < outputs[o].size(); ++line) {
      const std::size_t same = lines_that_agree(fragment, outputs[o], line);
      if (same > 0 && same >= best.same) best = {o, line, same};
    }
  return best;
}

/// Lines of the page that differ from the output at that place, as "page:12: printed ..., found ...".
/// @param digits units of the last digit that a number of this page may differ by
inline std::string disagreement(const Fragment& fragment, const std::vector<std::string>& output,
                                std::size_t line, double digits) {
  std::string text;
  for (std::size_t i = 0; i < fragment.text.size(); ++i) {
    const std::string found = line + i < output.size() ? output[line + i] : "(the end)";
    if (!same_as_printed(fragment.text[i], found, digits))
      text += fmt::format("  line {}\n    printed {}\n    found   {}\n", fragment.line + int(i),
                          fragment.text[i], found);
  }
  return text;
}

}  // namespace beamid::docs
