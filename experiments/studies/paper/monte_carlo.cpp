#include "experiments/studies/paper/monte_carlo.hpp"

#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "experiments/studies/paper/report.hpp"
#include "fem/assembly.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "filters/fisher_information.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments::paper {
namespace {

// Standard deviations that no unbiased estimate of K and C from the whole acceleration record falls below.
Eigen::Vector2d bound(const fem::StructuralSystem& reduced, const Oscillator& truth,
                      const ReleasedBeam& released) {
  const auto model = model_registry().make("sdof", {{"sensor_bias", false}},
                                           at_one_point(reduced, {Quantity::acceleration}));
  const double dt = released.time[1] - released.time[0];
  const auto discrete = filters::discretise(
      model->motion, dt, "exponential", {{}, Eigen::MatrixXd::Constant(1, 1, sensor_noise * sensor_noise)});
  const Eigen::Vector4d state(released.modal_amplitudes[0], 0.0, truth.stiffness, truth.damping);
  return filters::cramer_rao_bound(fisher_information(*discrete, state, released.time.size())).tail<2>();
}

}  // namespace

BeamCase prepare(const TestBeam& test) {
  BeamCase beam;
  beam.test = test;
  const Release settings = release_of(test);
  beam.released = release(settings);
  const fem::ExactMode exact(steel_beam(test), 1);
  beam.exact_frequency_hz = exact.frequency_hz();
  const auto rayleigh = reduction::reduction_registry().make("rayleigh", {});
  const auto reduced = reduce(fem::assemble(settings.beam, settings.elements), *rayleigh);
  beam.model = *model_registry().make(
      "sdof", {}, at_one_point(reduced.system, {Quantity::displacement, Quantity::velocity}));
  beam.reference = Oscillator::from_frequency(beam.model.equivalent_mass, exact.angular_frequency(),
                                              test.first_damping_ratio);
  const Eigen::Vector2d bounds = bound(reduced.system, beam.reference, beam.released);
  beam.stiffness_bound = bounds[0];
  beam.damping_bound = bounds[1];
  return beam;
}

double second_mode_velocity(const BeamCase& beam) {
  return std::abs(beam.released.modal_amplitudes[1]) * beam.released.modes.angular_frequency[1];
}

BeamSettings tuned_settings(const BeamCase& beam) {
  const double frequency = beam.released.modes.frequency_hz()[0];
  BeamSettings settings;
  settings.high_pass_hz = 0.5 * frequency;
  settings.low_pass_hz = 2.5 * frequency;
  settings.skipped = 3.0 / frequency;
  settings.first_stiffness = 0.8 * beam.reference.stiffness;
  return settings;
}

BeamSettings wide_settings(const BeamCase& beam) {
  BeamSettings settings;
  settings.high_pass_hz = 0.5;
  settings.noise_variance.setConstant(1e-5);
  settings.initial_variance << 1.0, 1.0, 1e5, 1e5;
  settings.first_stiffness = 0.8 * beam.reference.stiffness;
  return settings;
}

BeamSettings zero_phase_settings(const BeamCase& beam) {
  BeamSettings settings = tuned_settings(beam);
  settings.zero_phase = true;
  settings.skipped_at_end = settings.skipped;
  return settings;
}

BeamSettings zero_phase_wide_settings(const BeamCase& beam) {
  BeamSettings settings = wide_settings(beam);
  settings.zero_phase = true;
  return settings;
}

filters::Measurements process(const Record& acceleration, const BeamSettings& settings) {
  ProcessingSettings processing;
  processing.high_pass_hz = settings.high_pass_hz;
  processing.high_pass_order = processing.low_pass_order = 2;
  if (settings.low_pass_hz > 0.0) processing.low_pass_hz = settings.low_pass_hz;
  processing.zero_phase = settings.zero_phase;
  const double dt = acceleration.interval();
  const ProcessedMotion motion =
      process_acceleration(acceleration.channel(Quantity::acceleration), dt, processing);
  const auto first = static_cast<Eigen::Index>(std::lround(settings.skipped / dt));
  const Eigen::Index count =
      acceleration.size() - first - static_cast<Eigen::Index>(std::lround(settings.skipped_at_end / dt));
  filters::Measurements result;
  result.time = acceleration.time.segment(first, count);
  result.outputs.resize(2, count);
  result.outputs << motion.displacement.segment(first, count).transpose(),
      motion.velocity.segment(first, count).transpose();
  return result;
}

filters::Measurements true_motion(const BeamCase& beam) {
  const auto& [displacement, velocity, acceleration] = beam.released.tip;
  filters::Measurements result{beam.released.time, Eigen::MatrixXd(2, displacement.size()), {}};
  result.outputs << displacement.transpose(), velocity.transpose();
  return result;
}

Identification identify(const BeamCase& beam, const filters::Measurements& motion,
                        const BeamSettings& settings, const std::string& filter, const std::string& scheme) {
  IdentificationSettings identification;
  identification.filter = filter;
  identification.discretisation = scheme;
  identification.initial.mean.resize(4);
  identification.initial.mean << motion.outputs.col(0), settings.first_stiffness, settings.first_damping;
  identification.initial.covariance = settings.initial_variance.asDiagonal();
  identification.output_noise = settings.noise_variance.asDiagonal();
  if (settings.process_variance > 0.0)
    identification.process_noise =
        Eigen::Vector4d(settings.process_variance, settings.process_variance, 0.0, 0.0).asDiagonal();
  return experiments::identify(beam.model, motion, identification);
}

ReferenceAnalysis analyse(const BeamCase& beam, const Record& acceleration,
                          const filters::Measurements& motion) {
  const double dt = acceleration.interval();
  const double from = motion.time[0];
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = beam.reference.frequency_hz();
  const Record window = acceleration.window(from, acceleration.time[acceleration.size() - 1]);
  return {dominant_mode(window.channel(Quantity::acceleration), dt, settings),
          logarithmic_decrement(motion.outputs.row(0).transpose(), dt)};
}

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
