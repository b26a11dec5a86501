// Text for a terminal: how wide it is and where its lines break.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace beamid::experiments {

/// Widest line where nobody says how wide the terminal is [terminal columns].
inline constexpr std::size_t page_width = 100;

/// What text is printed for.
struct Page {
  std::size_t width = page_width;  ///< widest line [terminal columns]
  bool colour = false;             ///< whether escape sequences may mark what is wrong
};

/// Terminal columns of a UTF-8 text, one per code point.
std::size_t width_of(std::string_view text);

/// The text's lines, broken at blanks to at most `width` columns; a longer word stays whole.
///
/// A line that fits is kept as it is. What continues a broken line is indented as that line is, and two
/// columns further below a list mark "- ".
std::vector<std::string> wrapped(std::string_view text, std::size_t width = page_width);

/// A line with what is wrong in it, DIVERGED, ALIASED, THE RECORDS DISAGREE, ..., in bold red where the page
/// has colours.
std::string emphasised(const std::string& line, const Page& page);

}  // namespace beamid::experiments
