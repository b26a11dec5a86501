// Text for a person: how wide it is, where its lines break, and how a key reads.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/results/figure.hpp"

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

/// A key as a person reads it: "damping.ratio" as "damping ratio [-]", "stiffness_n_per_m" as "stiffness
/// [N/m]", "sensors[1].noise_m" as "sensors[1] noise [m]".
std::string key_label(const std::string& key);

// Ranges and ticks of an axis that a person reads at a glance.

using AxisRange = std::pair<double, double>;

constexpr double tick_letter = 8.3;  // [px] of a digit at the 13 px of the SVG's font

/// "set xtics ..." with the labels' format.
struct Ticks {
  std::string commands;
  double widest = 0;  ///< [px]
};

/// The least of 1, 2 and 5 times a power of ten that is not below `size`.
double rounded_up_step(double size);

/// The step of a linear axis whose labels have room on `length` px, with two of them in the range at least.
double step_for(const AxisRange& range, double length, bool upright);

/// @param name 'x' or 'y'
Ticks linear_ticks(char name, const AxisRange& range, double step);

/// Powers of ten or, where the axis is too short for those, the numbers between them that have room.
Ticks logarithmic_ticks(char name, const AxisRange& range, double length);

/// Names at the places 1, 2, ...
/// @param name "x", "y" or "y2"
Ticks named_ticks(const std::string& name, const std::vector<std::string>& names);

/// A word as a shell takes it: in quotes where it holds more than letters, digits and the signs of paths.
std::string shell_word(const std::string& word);

}  // namespace beamid::experiments
