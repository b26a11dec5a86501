// A stretch of a beam: its bending stiffness, read and scaled.
#pragma once

#include <utility>

#include "fem/beam.hpp"

namespace beamid::fem {

using Region = std::pair<double, double>;  ///< from, to [m], along the beam

/// How far into a segment that begins at `start` a place lies, from 0 to 1; at its end where only the
/// rounding of sums of lengths tells it apart.
double share_of(const Segment& segment, double start, double place);

/// Integral of E I, damage included, over the region [N m3].
double bending_integral(const Beam& beam, const Region& region);

/// Segments are cut at the region's ends, those inside made stiffer by the factor, in shear too; the length
/// is kept to the last bit, for bodies sit at its end.
void scale_bending(Beam& beam, const Region& region, double factor);

}  // namespace beamid::fem
