#include "experiments/studies/paper/alternative_chains.hpp"

#include "experiments/signal/butterworth.hpp"
#include "fem/free_decay.hpp"

namespace beamid::experiments::paper {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double settled_to = 1e-6;  // of the high-pass's transient, where it is left out

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

}  // namespace

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

}  // namespace beamid::experiments::paper
