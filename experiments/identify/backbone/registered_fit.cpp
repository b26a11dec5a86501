#include "experiments/identify/backbone/registered_fit.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/identify/model_setting.hpp"
#include "experiments/models/one_coordinate.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Where a fit begins, and the unit of each entry of the state.
struct ScaledState {
  VectorXd state, scale;
};

ScaledState scaled_start(const JointModel& model, const Oscillator& oscillator, const ModelStart& start,
                         const Eigen::Vector2d& motion, double offset) {
  ScaledState result;
  result.state = result.scale = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  VectorXd &state = result.state, &scale = result.scale;
  const double omega = oscillator.angular_frequency(),
               size = motion.norm() > 0 ? std::hypot(motion[0], motion[1] / omega) : 1;
  state.head<2>() = motion;
  scale.head<2>() << size, size * omega;
  for (const Index slip : model.slips) scale[slip] = size;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    for (const auto& [quantity, value] : start)
      if (model.unknowns[j].quantity == quantity) {
        state[model.unknown_places[j]] = model.unknowns[j].to_state(value);
        scale[model.unknown_places[j]] = std::max(std::abs(value), 1e-3 * model.unknowns[j].deviation);
      }
  for (const JointModel::Offset& one : model.offsets) {
    state[one.place] = offset;
    scale[one.place] = size * omega * omega;
  }
  return result;
}

RecordFit fit_from(const std::string& name, const JointModel& model, const DecaySamples& samples,
                   double noise, const ScaledState& start) {
  const auto discrete = filters::discretise(model.motion, samples.interval() / samples.steps, "runge_kutta_4",
                                            {{}, MatrixXd::Constant(1, 1, noise * noise)});
  const filters::BatchEstimate found =
      filters::estimate_batch(*discrete, start.state, start.scale.asDiagonal(), samples.fine,
                              samples.batch_settings(samples.steps, true, 12));
  RecordFit fit = record_fit(name, found, samples, samples.steps);
  fit.unknowns = start.state.size();
  return fit;
}

}  // namespace

RecordFit registered_fit(const std::string& name, const DecaySamples& samples, double mass, double noise,
                         const Eigen::Vector2d& motion, double offset,
                         const std::vector<ModelStart>& starts) {
  RecordFit best;
  best.name = name;
  for (const ModelStart& start : starts) {
    const Oscillator oscillator{mass, start[0].second, start[1].second};
    const auto model =
        model_registry().make(name, {}, at_one_point(one_coordinate(oscillator), {samples.quantity}));
    const ScaledState begin = scaled_start(*model, oscillator, start, motion, offset);
    try {
      RecordFit fit = fit_from(name, *model, samples, noise, begin);
      if (fit.residuals.size() == 0) {
        if (best.residuals.size() == 0) best.reason = fit.reason;
        continue;
      }
      if (best.residuals.size() == 0 || fit.left < best.left) best = std::move(fit);
    } catch (const std::exception& error) {
      if (best.residuals.size() == 0) best.reason = error.what();
    }
  }
  return best;
}

}  // namespace beamid::experiments
