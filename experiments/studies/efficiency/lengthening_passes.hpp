// A filter that finds constants from a poor guess: pass after pass over more and more of the record.
#pragma once

#include <optional>
#include <vector>

#include "filters/filter.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

struct LengtheningSettings {
  Eigen::Index first_samples = 50;  ///< of the shortest part, then twice as many, and so on to the whole
  int passes = 2;                   ///< over each part
  int last_passes = 3;              ///< over the whole record
  /// A pass starts from deviations of the constants so many times what the one before ended with, at most
  /// from the first ones.
  double widening = 10.0;
};

/// A long oscillation has a wrong answer for every cycle missed, and an estimate that linearises about a poor
/// guess settles in one. Over the first cycle there is none. Every further pass
///
///     mean_c := what the pass before found,   deviation_c := min(first, w * what the pass before told)
///
/// of the constants c, motion as unknown as at first, is a Gauss-Newton step with a small prior about the
/// present estimate: where the passes converge, the prior pulls nowhere, and all that remains of it is that
/// told deviations are too small by 1/(2 w^2). Nothing but the filter is used.
/// @param constants entries of the state that do not move. @returns the last estimate; nothing where a pass
/// failed. @throws std::invalid_argument when a number is out of range or sizes disagree.
std::optional<filters::Gaussian> lengthening_passes(filters::Filter& filter, const filters::Gaussian& initial,
                                                    const filters::Measurements& record,
                                                    const std::vector<Eigen::Index>& constants,
                                                    const LengtheningSettings& settings = {});

}  // namespace beamid::experiments
