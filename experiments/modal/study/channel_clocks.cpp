#include "experiments/modal/study/channel_clocks.hpp"

#include <cmath>
#include <numbers>

#include "experiments/modal/clock_scatter.hpp"

namespace beamid::experiments {

void compare_clocks(const JointDecayFit& fit, RecordModes& found) {
  const auto scatter = clock_scatter(fit);
  if (!scatter) return;
  for (std::size_t m = 0; m < found.modes.size(); ++m) {
    double& deviation = found.modes[m].pole.frequency_deviation_hz;
    deviation =
        std::hypot(deviation, scatter->farthest[static_cast<Eigen::Index>(m)] / (2.0 * std::numbers::pi));
  }
  found.warnings.push_back(scatter->sentence(found.record.channel_names()) +
                           " A frequency cannot say which is right; its deviations are widened by how far "
                           "its channels are from it.");
}

}  // namespace beamid::experiments
