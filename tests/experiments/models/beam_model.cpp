#include "tests/experiments/models/beam_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

fem::Beam elastic_root() {
  fem::Beam beam = test::steel_beam(0.36);
  beam.supports = {{0.0, true, false}};
  beam.springs = {{0.0, 0.0, 4e3, 0.0}};
  beam.bodies[0].rotary_inertia = 1e-3;
  return beam;
}

const std::vector<ParameterChoice> all_parameters{test::in_region(0.0, 0.3),
                                                  test::in_region(0.3, 1.1),
                                                  test::parameter("tip_mass"),
                                                  test::parameter("tip_rotary_inertia"),
                                                  test::parameter("root_rotational_stiffness"),
                                                  test::of_mode("damping_ratio", 1),
                                                  test::parameter("damping_ratio"),
                                                  test::parameter("mass_damping"),
                                                  test::parameter("stiffness_damping")};

}  // namespace

std::unique_ptr<JointModel> beam_model(const ModelSetting& setting, const filters::Options& options) {
  return model_registry().make("beam", options, setting);
}

VectorXd state_at_guess(const JointModel& model) {
  VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    state[model.unknown_places[j]] = model.unknowns[j].to_state(model.unknowns[j].guess);
  return state;
}

void set_unknown(const JointModel& model, VectorXd& state, std::size_t j, double value) {
  state[model.unknown_places[j]] = model.unknowns[j].to_state(value);
}

std::vector<std::complex<double>> upper_eigenvalues(const JointModel& model, const VectorXd& state) {
  Eigen::MatrixXd matrix;
  dynamic_cast<const filters::LinearMotion&>(*model.motion).motion_matrix(state, matrix);
  const Eigen::VectorXcd all = matrix.eigenvalues();
  std::vector<std::complex<double>> upper;
  for (const auto& value : all)
    if (value.imag() > 0.0) upper.push_back(value);
  std::sort(upper.begin(), upper.end(), [](auto a, auto b) { return a.imag() < b.imag(); });
  return upper;
}

ModelSetting rich_beam_setting() {
  ModelSetting setting = test::beam_setting(elastic_root(), 20,
                                            {{Quantity::acceleration, 1.1},
                                             {Quantity::velocity, 0.5},
                                             {Quantity::strain, 0.3},
                                             {Quantity::displacement, 1.1}},
                                            {1.1, 0.5});
  setting.continuum->structure = fem::with_nodes(setting.continuum->structure.beam(), {0.3});
  setting.forces.push_back(setting.system.inputs.cols() - 1);  // the base, too
  setting.damping = fem::ModalDamping{{0.004, 0.01}};
  setting.parameters = all_parameters;
  setting.parameters[7].guess = 0.1;
  setting.parameters[8].guess = 1e-5;
  setting.parameters[1].form = Form::logarithmic;
  setting.parameters[2].lower = 0.1;
  setting.parameters[2].upper = 1.0;
  return setting;
}

}  // namespace beamid::experiments
