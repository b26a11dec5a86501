#include "experiments/rig/storey_response.hpp"

#include <fmt/format.h>

#include <numeric>
#include <stdexcept>

#include "experiments/models/joint_model.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// The chain as described, every input of it measured.
JointModel described_chain(const Experiment& experiment, const fem::StructuralSystem& system,
                           const std::vector<fem::Point>& points) {
  ModelSetting setting;
  setting.system = system;
  setting.observations.assign(static_cast<std::size_t>(system.outputs.rows()), {Quantity::displacement});
  setting.forces.resize(static_cast<std::size_t>(system.inputs.cols()));
  std::iota(setting.forces.begin(), setting.forces.end(), Index{0});
  setting.parameters = {{"storey_stiffness"}};  // some unknown there must be: it stays as described
  setting.damping = experiment.damping;
  setting.storey_springs = experiment.storey_springs;
  setting.continuum = ModelSetting::Continuum{experiment.structure, experiment.elements, points};
  return std::move(*model_registry().make("beam", {{"sensor_bias", false}}, setting));
}

}  // namespace

fem::Response storey_response(const Experiment& experiment, const fem::StructuralSystem& system,
                              const std::vector<fem::Point>& points, const fem::Loading& loading,
                              const fem::TimeGrid& grid) {
  if (experiment.simulation.method.name != "modal")
    throw std::invalid_argument(
        "method '" + experiment.simulation.method.name +
        "' moves linear storeys; expected no [simulation] method beside [[chain.storeys]], "
        "which CVODES moves");
  const JointModel model = described_chain(experiment, system, points);
  const Index n = system.size(), p = system.outputs.rows();
  const auto step = filters::discretise(model.motion, grid.interval, "cvode", {{}, MatrixXd::Identity(p, p)});
  VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size())), next, rate;
  if (loading.initial_displacement.size() > 0) state.head(n) = loading.initial_displacement;
  if (loading.initial_velocity.size() > 0) state.segment(n, n) = loading.initial_velocity;
  state[model.unknown_places[0]] = model.unknowns[0].guess;

  fem::Response response;
  response.time =
      grid.interval * VectorXd::LinSpaced(grid.samples, 0.0, static_cast<double>(grid.samples - 1));
  for (MatrixXd* rows : {&response.displacement, &response.velocity, &response.acceleration})
    rows->resize(p, grid.samples);
  response.frames = grid.frames;
  const auto frames = static_cast<Index>(grid.frames.size());
  for (MatrixXd* field :
       {&response.field_displacement, &response.field_velocity, &response.field_acceleration})
    field->resize(n, frames);
  const Index inputs = system.inputs.cols();
  const auto input_at = [&](Index k) -> VectorXd {
    return loading.inputs.size() > 0 ? VectorXd(loading.inputs.col(k)) : VectorXd::Zero(inputs);
  };
  for (Index k = 0, frame = 0; k < grid.samples; ++k) {
    const VectorXd input = input_at(k);
    model.motion->rate(state, input, rate);
    const VectorXd q = state.head(n), v = state.segment(n, n), a = rate.segment(n, n);
    response.displacement.col(k) = system.outputs * q;
    response.velocity.col(k) = system.outputs * v;
    response.acceleration.col(k) = system.outputs * a;
    if (frame < frames && grid.frames[static_cast<std::size_t>(frame)] == k) {
      response.field_displacement.col(frame) = q;
      response.field_velocity.col(frame) = v;
      response.field_acceleration.col(frame++) = a;
    }
    if (k + 1 == grid.samples) break;
    VectorXd path(2 * inputs);
    path << input, input_at(k + 1) - input;
    try {
      step->transition(state, path, next);
    } catch (const std::runtime_error& error) {
      throw InputError(
          experiment.storey_springs.front().law.place,
          fmt::format("the motion of storeys that follow laws cannot be followed beyond {:.4g} s ({}): "
                      "a spring that softens lets go where the motion is large. Expected a smaller "
                      "excitation, or a law that pushes back",
                      response.time[k], error.what()));
    }
    state.swap(next);
  }
  return response;
}

}  // namespace beamid::experiments
