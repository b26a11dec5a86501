// Even samples whose stamps are printed coarsely.
#pragma once

#include <optional>
#include <vector>

namespace beamid::experiments {

struct EvenStamps {
  std::vector<double> times;  ///< (N), as the stamps that were given
  double interval = 0.0;      ///< between neighbours, in their unit
};

/// The line t = a + n dt through all stamps, n counting samples, lost ones too, by least squares: of the
/// first and the last stamp alone, each rounded by up to half a resolution, the interval would be wrong by as
/// much over the duration, 1e-4 of 10 s printed to 1 ms. Nothing where the stamps lie on the line as they
/// are, where rounding does not explain how far they are from it (they jitter), or where it is below 2e-3
/// of an interval: 2e-6 of the rate over 1,000 samples.
/// @param times (N), increasing; @param resolution to which they are printed
std::optional<EvenStamps> without_rounding(const std::vector<double>& times, double resolution);

}  // namespace beamid::experiments
