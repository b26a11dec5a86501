// Ranges and ticks of an axis that a person reads at a glance.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
