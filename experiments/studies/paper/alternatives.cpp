#include "experiments/studies/paper/alternatives.hpp"

#include <tbb/parallel_for.h>

#include <functional>

#include "experiments/signal/butterworth.hpp"
#include "experiments/studies/paper/errors.hpp"
#include "fem/free_decay.hpp"

namespace beamid::experiments::paper {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double settled_to = 1e-6;  // of the high-pass's transient, where it is left out

// Displacement and velocity as the chain of 2009 makes them of a clean acceleration, and where it has
// settled.
struct ChainMotion {
  VectorXd displacement, velocity;
  Index first = 0;
};

struct CleanMode {
  VectorXd acceleration;
  CascadedFilter high_pass;
  double interval = 0.0;
  Index settled = 0;
};

CleanMode clean_mode(const BeamCase& beam) {
  const auto one = [](double value) { return VectorXd::Constant(1, value); };
  CleanMode mode;
  mode.acceleration =
      fem::free_decay(one(beam.released.modal_amplitudes[0]), one(beam.reference.angular_frequency()),
                      one(beam.reference.damping_ratio()), beam.released.time)
          .acceleration;
  mode.interval = beam.released.time[1] - beam.released.time[0];
  mode.high_pass = butterworth_high_pass(2, wide_settings(beam).high_pass_hz, mode.interval);
  mode.settled = settling_samples(mode.high_pass, settled_to);
  return mode;
}

// v_k = v_(k-1) + dt a_k
VectorXd rectangle_sum(const VectorXd& signal, double interval) {
  VectorXd sum(signal.size());
  double value = 0.0;
  for (Index k = 0; k < signal.size(); ++k) sum[k] = value += interval * signal[k];
  return sum;
}

ChainMotion integrated(const CleanMode& mode, bool from_rest) {
  const VectorXd a = filter_causally(mode.high_pass, mode.acceleration);
  const double half = from_rest ? 0.5 * mode.interval : 0.0;
  ChainMotion motion;
  motion.velocity = cumulative_trapezoid(a, mode.interval, half * a[0]);
  motion.displacement = cumulative_trapezoid(motion.velocity, mode.interval, half * motion.velocity[0]);
  motion.first = mode.settled;
  return motion;
}

struct Alternative {
  const char* name;
  std::function<ChainMotion(const CleanMode&)> chain;
};

const std::vector<Alternative>& compared_alternatives() {
  static const std::vector<Alternative> alternatives{
      {"high-pass, its transient left out", [](const CleanMode& mode) { return integrated(mode, true); }},
      {"high-pass, its transient kept",
       [](const CleanMode& mode) {
         ChainMotion motion = integrated(mode, true);
         motion.first = 0;
         return motion;
       }},
      {"acceleration and its integral taken for v and x",  // two derivatives of the motion: the same pole
       [](const CleanMode& mode) {
         ChainMotion motion = integrated(mode, true);
         motion.displacement = motion.velocity;
         motion.velocity = filter_causally(mode.high_pass, mode.acceleration);
         return motion;
       }},
      {"displacement high-passed once more",
       [](const CleanMode& mode) {
         ChainMotion motion = integrated(mode, true);
         motion.displacement = filter_causally(mode.high_pass, motion.displacement);
         motion.first = 2 * mode.settled;
         return motion;
       }},
      {"integrals by the rectangle rule",
       [](const CleanMode& mode) {
         ChainMotion motion = integrated(mode, true);
         const VectorXd a = filter_causally(mode.high_pass, mode.acceleration);
         motion.velocity = rectangle_sum(a, mode.interval);
         motion.displacement = rectangle_sum(motion.velocity, mode.interval);
         return motion;
       }},
      {"integrals half a sample late: a drift", [](const CleanMode& mode) {
         ChainMotion motion = integrated(mode, false);
         motion.first = 0;
         return motion;
       }}};
  return alternatives;
}

Identification identify_chain(const BeamCase& beam, const ChainMotion& motion, double process_variance) {
  const Index count = beam.released.time.size() - motion.first;
  filters::Measurements record{beam.released.time.tail(count), Eigen::MatrixXd(2, count), {}};
  record.outputs << motion.displacement.tail(count).transpose(), motion.velocity.tail(count).transpose();
  BeamSettings settings = wide_settings(beam);
  settings.process_variance = process_variance;
  return identify(beam, record, settings, "ekf", "exponential");
}

}  // namespace

std::vector<AlternativeCase> examine_alternatives(const std::vector<const BeamCase*>& beams) {
  std::vector<AlternativeCase> cases;
  const auto count = static_cast<Index>(beams.size());
  for (const Alternative& alternative : compared_alternatives())
    cases.push_back({alternative.name, VectorXd(count), VectorXd(count), VectorXd(count)});
  tbb::parallel_for(Index{0}, count, [&](Index b) {
    const BeamCase& beam = *beams[static_cast<std::size_t>(b)];
    const CleanMode mode = clean_mode(beam);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const ChainMotion motion = compared_alternatives()[i].chain(mode);
      const Oscillator quiet = identify_chain(beam, motion, 0.0).found,
                       noisy = identify_chain(beam, motion, alternative_process_variance).found;
      cases[i].damping_error_percent[b] = damping_error(quiet, beam.reference);
      cases[i].stiffness_error_percent[b] = stiffness_error(quiet, beam.reference);
      cases[i].noisy_damping_error_percent[b] = damping_error(noisy, beam.reference);
    }
  });
  return cases;
}

Table alternative_table(const std::vector<AlternativeCase>& cases) {
  Table table{"alternatives",
              "Other causes, one at a time, before the exact filter: error of C on five beams [%]"};
  table.column({"done to a clean first mode", "alternative"})
      .column({"K, largest [%]", "largest_stiffness_error_percent", "{:.4f}"})
      .column({"C, least [%]", "least_damping_error_percent", "{:+.3f}"})
      .column({"C, largest [%]", "largest_damping_error_percent", "{:+.3f}"})
      .column({"C with Q, least [%]", "least_damping_error_with_process_noise_percent", "{:+.3f}"})
      .column({"C with Q, largest [%]", "largest_damping_error_with_process_noise_percent", "{:+.3f}"});
  for (const AlternativeCase& one : cases)
    table.row({one.name, one.stiffness_error_percent.cwiseAbs().maxCoeff(),
               one.damping_error_percent.minCoeff(), one.damping_error_percent.maxCoeff(),
               one.noisy_damping_error_percent.minCoeff(), one.noisy_damping_error_percent.maxCoeff()});
  table.note =
      "The chain of 2009 (high-pass at 0.5 Hz, R = 1e-5 I, P0 of K and C 1e5) on 25 s of the first mode "
      "alone, no "
      "noise. With Q: process noise of 1e-8 of x and v per step, which the digits of table 2 exclude.";
  return table;
}

}  // namespace beamid::experiments::paper
