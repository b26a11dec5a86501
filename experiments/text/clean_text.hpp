// Texts from outside, fit to be shown anywhere.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace beamid::experiments {

/// The text in UTF-8 and on one line, without anything that a terminal, a page, a table or a plot takes for a
/// command: control characters (U+0000 to U+001F, U+007F to U+009F) and those that XML forbids are dropped;
/// tabs and line breaks become blanks. A byte that is not UTF-8 is taken for ISO 8859-1, in which loggers
/// write "m/s²".
std::string clean_text(std::string_view text);

/// The same with its line breaks: for what is printed as a whole.
std::string clean_lines(std::string_view text);

/// Where the first control character, a tab or a line break too, begins; npos: nowhere.
std::size_t find_control(std::string_view text);

}  // namespace beamid::experiments
