// Curves of long records cut and thinned before they are written.
#pragma once

#include <utility>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// Whether a curve is drawn as a line or an area, which may be thinned; of points each counts.
bool is_line(const Curve& curve);

/// The curve inside a horizontal range, with one point more on each side for the line to enter by. Abscissae
/// ascend.
Curve visible_part(const Curve& curve, const std::pair<double, double>& range);

/// The panel with the points that write() would write, in the memory of these: a million samples take 16 MB a
/// curve before and 60 kB after. Files and pictures are the same. The range of the x axis is set before;
/// where the y axis has none and the visible part of a curve has not the extent of the whole, the panel stays
/// as it is.
Panel thinned(Panel panel);

}  // namespace beamid::experiments
