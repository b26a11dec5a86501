// Are the instants of a record evenly spaced, and where not?
#pragma once

#include <cstddef>
#include <vector>

namespace beamid::experiments {

struct SamplingCheck {
  double interval = 0.0;  ///< median [s]
  double jitter = 0.0;    ///< root mean square of the intervals' distance from their mean, gaps aside [s]
  std::vector<std::size_t>
      gaps;  ///< samples that come more than half an interval too late; where stamps jitter, more than 1.5
  std::vector<std::size_t> repeats;  ///< samples whose stamp is that of the one before
  std::vector<std::size_t> returns;  ///< samples before the one before
  double longest_gap = 0.0;          ///< [s]
  bool uniform = true;  ///< every interval within 5 % of the median, or within the rounding of the stamps
};

/// @param times [s], at least two. @param resolution to which they are printed [s].
SamplingCheck check_sampling(const std::vector<double>& times, double resolution);

}  // namespace beamid::experiments
