#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/identify/engine/first_guess.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/identification.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

// Places of K and C in [x, v, K, C, ...], as model sdof has them of a free decay.
constexpr Index stiffness_place = 2, damping_place = 3;

}  // namespace

std::optional<StartedModel> started_from_mode(const JointModel& model, const Prior& prior,
                                              const ModalEstimate& modal, const std::string& scheme,
                                              double interval) {
  constexpr double counted_twice = 30, least = 0.01, most = 0.3, usual_ratio = 0.01, largest_ratio = 0.5;
  if (!is_oscillator(model) || !(modal.damping_ratio < largest_ratio)) return {};
  const double frequency_deviation = modal.frequency_standard_deviation_hz / modal.frequency_hz,
               ratio_deviation = modal.damping_ratio_standard_deviation;
  if (!std::isfinite(frequency_deviation) || !std::isfinite(ratio_deviation)) return {};
  Oscillator start =
      Oscillator::from_frequency(model.equivalent_mass, 2.0 * std::numbers::pi * modal.frequency_hz,
                                 modal.damping_ratio > 0 ? modal.damping_ratio : usual_ratio);
  try {
    start = seen_through(scheme, start, interval);
  } catch (const std::runtime_error&) {  // the step is too long for the scheme, which will show
  }
  if (!(start.stiffness > 0.0) || !std::isfinite(start.damping)) return {};

  StartedModel begun{model, {}, {}};
  begun.linearised_at = Eigen::VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  begun.linearised_at[stiffness_place] = start.stiffness;
  begun.linearised_at[damping_place] = start.damping;
  begun.guess.mean = begun.linearised_at;
  const double of_stiffness =
                   start.stiffness * std::clamp(2.0 * counted_twice * frequency_deviation, least, most),
               of_damping = std::max(std::abs(start.damping), 2.0 * counted_twice * ratio_deviation *
                                                                  std::sqrt(start.stiffness * start.mass));
  Eigen::Vector2d deviations(of_stiffness, of_damping);
  if (prior.states_stiffness()) {
    begun.guess.mean[stiffness_place] = model.unknowns[0].guess;
    deviations[0] = model.unknowns[0].deviation;
  }
  if (prior.states_damping()) {
    begun.guess.mean[damping_place] = model.unknowns[1].guess;
    deviations[1] = model.unknowns[1].deviation;
  }
  begun.guess.unknowns = deviations.cwiseAbs2().asDiagonal();
  return begun;
}

}  // namespace beamid::experiments
