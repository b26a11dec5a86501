#include "experiments/rig/sample_clock.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/rig/acquisition.hpp"
#include "experiments/signal/cubic_spline.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

SampleClock clock_of(const Acquisition& acquisition, const Simulation& settings, Index count) {
  SampleClock clock;
  clock.before = static_cast<Index>(std::llround(acquisition.pretrigger * settings.sampling_rate));
  clock.event = static_cast<double>(clock.before) / settings.sampling_rate;
  clock.time = sample_instants(acquisition, clock.before + count, settings.sampling_rate, settings.seed);
  clock.even = !(acquisition.jitter > 0);
  return clock;
}

VectorXd readings_at(const SampleClock& clock, const VectorXd& step_time, const VectorXd& values, Index steps,
                     Quantity quantity) {
  const bool held = quantity == Quantity::displacement || quantity == Quantity::strain;
  VectorXd readings = VectorXd::Constant(clock.time.size(), held ? values[0] : 0.0);
  if (clock.even) {
    const Index count = clock.time.size() - clock.before;
    readings.tail(count) = values(Eigen::seqN(Index{0}, count, steps));
    return readings;
  }
  const CubicSpline spline(step_time, values);
  const double last = step_time[step_time.size() - 1];
  for (Index k = 0; k < readings.size(); ++k)
    if (const double t = clock.time[k] - clock.event; t >= 0) readings[k] = spline(std::min(t, last));
  return readings;
}

}  // namespace beamid::experiments
