#include "experiments/studies/paper/monte_carlo.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "experiments/studies/paper/errors.hpp"

namespace beamid::experiments::paper {

std::uint64_t stream_of(int beam, int trial) {
  return static_cast<std::uint64_t>(beam) << 32 | static_cast<std::uint64_t>(trial);
}

TrialStatistics repeat(const BeamCase& beam, int beam_number, int trials, std::uint64_t seed) {
  const BeamSettings settings = tuned_settings(beam);
  Eigen::ArrayXd stiffness(trials), damping(trials);  // errors [%]
  Eigen::ArrayXi diverged(trials);
  tbb::parallel_for(0, trials, [&](int trial) {
    const Record record =
        measure_acceleration(beam.released, sensor_noise, seed, stream_of(beam_number, trial));
    const Identification result = identify(beam, process(record, settings), settings, "ekf", "exponential");
    stiffness[trial] = stiffness_error(result.found, beam.reference);
    damping[trial] = damping_error(result.found, beam.reference);
    diverged[trial] = lost(result, beam.reference.frequency_hz());
  });
  TrialStatistics statistics;
  statistics.trials = trials;
  statistics.diverged = diverged.sum();
  statistics.stiffness_mean_percent = stiffness.mean();
  statistics.damping_mean_percent = damping.mean();
  statistics.stiffness_rms_percent = std::sqrt(stiffness.square().mean());
  statistics.damping_rms_percent = std::sqrt(damping.square().mean());
  statistics.stiffness_bound_percent = 100.0 * beam.stiffness_bound / beam.reference.stiffness;
  statistics.damping_bound_percent = 100.0 * beam.damping_bound / beam.reference.damping;
  return statistics;
}

}  // namespace beamid::experiments::paper
