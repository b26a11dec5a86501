#include "experiments/identify/backbone/decay_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

filters::BatchSettings DecaySamples::batch_settings(int steps_between, bool grow, int most) const {
  constexpr double start_cycles = 3;  // from which the fit grows over the record
  filters::BatchSettings settings;
  settings.tolerance = 1e-2;
  settings.max_iterations = most;
  if (grow)
    settings.first_samples = static_cast<Index>(start_cycles / (frequency_hz * interval()) * steps_between);
  return settings;
}

DecaySamples decay_samples(const VectorXd& signal, double interval, Quantity quantity, double frequency_hz,
                           double samples_per_period) {
  constexpr double steps_per_period = 48;
  DecaySamples result;
  const int factor = decimation_factor(1 / (samples_per_period * frequency_hz * interval), signal.size());
  result.factor = factor >= 4 ? factor : 1;  // a low-pass costs the first samples, the largest
  const DecimatedSignal kept = decimate(signal, interval, result.factor);
  if (result.factor > 1) result.whiteness = result.factor * kept.kernel.squaredNorm();
  result.lost = kept.start;
  result.frequency_hz = frequency_hz;
  result.quantity = quantity;
  result.steps = std::max(1, static_cast<int>(std::ceil(steps_per_period * frequency_hz * kept.interval)));
  const Index count = kept.samples.size(), n = (count - 1) * result.steps + 1;
  result.plain.time = kept.interval * VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  result.plain.outputs = kept.samples.transpose();
  result.fine.time = kept.interval / result.steps * VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1));
  result.fine.outputs.setConstant(1, n, std::numeric_limits<double>::quiet_NaN());
  for (Index k = 0; k < count; ++k) result.fine.outputs(0, k * result.steps) = kept.samples[k];
  return result;
}

}  // namespace beamid::experiments
