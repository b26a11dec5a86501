#include "experiments/identify/compare/started_model.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/identify/compare/nonlinear_guess.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/motion/following_motion.hpp"
#include "experiments/models/motion/second_order_motion.hpp"
#include "experiments/models/motion/storey_motion.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

constexpr Index most_started_coordinates = 12;  // a low-pass leaves fewer modes than that

// The same questions, guessed at what a state says.
std::vector<ParameterChoice> choices_at(const JointModel& model, const Eigen::VectorXd& state) {
  std::vector<ParameterChoice> choices;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j) {
    const Unknown& unknown = model.unknowns[j];
    ParameterChoice choice{unknown.quantity, unknown.name, unknown.region, unknown.mode};
    choice.guess = unknown.to_physical(state[model.unknown_places[j]]);
    choice.deviation = unknown.deviation;
    choice.form = unknown.form;
    if (std::isfinite(unknown.lower)) choice.lower = unknown.lower;
    if (std::isfinite(unknown.upper)) choice.upper = unknown.upper;
    choice.known = unknown.nuisance;
    choices.push_back(choice);
  }
  return choices;
}

// Constants of one model's state in the places that another has for them.
Eigen::VectorXd carried_over(const JointModel& from, const Eigen::VectorXd& state, const JointModel& to) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Index>(to.motion->state_labels().size()));
  result(to.unknown_places) = state(from.unknown_places);
  for (std::size_t i = 0; i < to.offsets.size(); ++i)
    result[to.offsets[i].place] = state[from.offsets[i].place];
  return result;
}

}  // namespace

StartedModel started_model(JointModel first, const Choice& model, const ModelSetting& setting,
                           const filters::Measurements& record, double frequency_hz) {
  const auto made = [&](const ModelSetting& of) {
    return std::move(*model_registry().make(model.name, model.options, of));
  };
  const Index modes = std::max(most_started_coordinates, first.mode_shapes.cols() + 4);
  const bool mesh = is_whole_mesh(first);
  if (is_nonlinear(first)) {
    FirstGuess guess = nonlinear_guess(first, setting.observations, record, frequency_hz);
    return {std::move(first), std::move(guess)};
  }
  // Few modes that follow can be brought to the frequency of one left out: all that the record may hold are
  // fitted first.
  const bool follows = setting.reduction && setting.reduction->spans_lowest_modes() &&
                       dynamic_cast<const FollowingMotion*>(first.motion.get());
  const bool part = !setting.supports.empty();  // in its own coordinates only
  if (part || (!mesh && !follows && first.motion_size() <= most_started_coordinates) ||
      modes >= setting.system.size() || first.unknowns.front().quantity.empty()) {
    FirstGuess guess = first_guess(first, setting.observations, record, frequency_hz);
    return {std::move(first), std::move(guess)};
  }
  ModelSetting truncated = setting;
  truncated.reduction = reduction::reduction_registry().make(
      "modal_truncation", {{"modes", static_cast<double>(mesh ? modes : most_started_coordinates)}});
  const JointModel small = made(truncated);
  const FirstGuess found = first_guess(small, setting.observations, record, frequency_hz, !mesh);
  if (mesh) {
    ModelSetting nearer = setting;
    nearer.parameters = choices_at(small, found.mean);
    first = made(nearer);
  }
  const Eigen::VectorXd mean = carried_over(small, found.mean, first);
  return {std::move(first), {mean, found.unknowns, found.by_lines}};
}

filters::Gaussian known_about_start(const StartedModel& started, const ModelSetting& setting,
                                    const Eigen::MatrixXd& outputs) {
  return {started.guess.mean(started.model.unknown_places),
          own_guess(started.model, setting.observations, outputs).unknowns,
          {}};
}

JointModel on_basis_at(const Choice& model, const ModelSetting& setting, const JointModel& from,
                       const Eigen::VectorXd& state) {
  const auto* storeys = dynamic_cast<const StoreyMotion*>(from.motion.get());
  const auto* motion = storeys ? static_cast<const SecondOrderMotion*>(&storeys->floors())
                               : dynamic_cast<const ReducedMotion*>(from.motion.get());
  if (!motion || motion->description().properties() == 0) return from;
  ModelSetting there = setting;
  there.parameters = choices_at(from, state);
  try {
    JointModel made = *model_registry().make(model.name, model.options, there);
    if (made.motion_size() != from.motion_size()) return from;
    made.unknowns = from.unknowns;
    return made;
  } catch (const std::invalid_argument&) {  // no such beam
    return from;
  } catch (const std::runtime_error&) {
    return from;
  }
}

}  // namespace beamid::experiments
