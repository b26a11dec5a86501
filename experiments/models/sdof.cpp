// One degree of freedom with known mass: state [x, v, K, C] and, where acceleration is observed, its sensor's
// bias b,
//
//     x' = v,   v' = -(K x + C v) / M,   K' = C' = b' = 0
//
// Observed: displacement x, velocity v or acceleration -(K x + C v) / M + b, in any mix.
#include <cmath>
#include <stdexcept>

#include "experiments/joint_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class SingleDegreeOfFreedom final : public filters::LinearMotion {
 public:
  SingleDegreeOfFreedom(double mass, std::vector<Quantity> observed, bool sensor_bias)
      : mass_(mass), observed_(std::move(observed)), parameters_(sensor_bias ? 3 : 2) {}

  std::vector<filters::Label> state_labels() const override {
    std::vector<filters::Label> labels{
        {"displacement", "m"}, {"velocity", "m/s"}, {"stiffness", "N/m"}, {"damping", "N s/m"}};
    if (parameters_ == 3) labels.push_back({"sensor_bias", "m/s2"});
    return labels;
  }
  std::vector<filters::Label> output_labels() const override {
    std::vector<filters::Label> labels;
    for (const Quantity quantity : observed_) labels.push_back({to_string(quantity), si_unit(quantity)});
    return labels;
  }
  Index motion_size() const override { return 2; }
  Index parameter_size() const override { return parameters_; }

  void motion_matrix(const VectorXd& state, MatrixXd& matrix) const override {
    matrix.resize(2, 2);
    matrix << 0.0, 1.0, -state[2] / mass_, -state[3] / mass_;
  }
  void motion_matrix_derivative(const VectorXd&, Index j, MatrixXd& matrix) const override {
    matrix.setZero(2, 2);
    if (j < 2) matrix(1, j) = -1.0 / mass_;
  }

  void output(const VectorXd& state, const VectorXd&, VectorXd& output) const override {
    output.resize(static_cast<Index>(observed_.size()));
    for (Index i = 0; i < output.size(); ++i) {
      if (observed_[i] == Quantity::displacement) output[i] = state[0];
      if (observed_[i] == Quantity::velocity) output[i] = state[1];
      if (observed_[i] == Quantity::acceleration)
        output[i] =
            -(state[2] * state[0] + state[3] * state[1]) / mass_ + (parameters_ == 3 ? state[4] : 0.0);
    }
  }
  void output_jacobian(const VectorXd& state, const VectorXd&, MatrixXd& jacobian) const override {
    jacobian.setZero(static_cast<Index>(observed_.size()), 2 + parameters_);
    for (Index i = 0; i < jacobian.rows(); ++i) {
      if (observed_[i] == Quantity::displacement) jacobian(i, 0) = 1.0;
      if (observed_[i] == Quantity::velocity) jacobian(i, 1) = 1.0;
      if (observed_[i] == Quantity::acceleration) {
        jacobian.row(i).head<4>() << -state[2], -state[3], -state[0], -state[1];
        jacobian.row(i) /= mass_;
        if (parameters_ == 3) jacobian(i, 4) = 1.0;
      }
    }
  }

 private:
  double mass_;  // [kg]
  std::vector<Quantity> observed_;
  Index parameters_;
};

// The beam's own stiffness and damping, to 30 % and to as much again.
std::vector<Unknown> unknowns(double mass, double stiffness, const fem::DampingLaw& law) {
  constexpr double stiffness_doubt = 0.3, usual_damping_ratio = 0.01;
  const double omega = std::sqrt(stiffness / mass);
  const bool described = !std::holds_alternative<fem::Undamped>(law);
  const double ratio =
      described ? fem::damping_ratios(law, VectorXd::Constant(1, omega))[0] : usual_damping_ratio;
  const double damping = 2.0 * ratio * omega * mass;
  return {{"stiffness", "N/m", stiffness, stiffness_doubt * stiffness},
          {"damping", "N s/m", damping, damping}};
}

std::unique_ptr<JointModel> make(const ModelSetting& setting, const filters::Options& options) {
  const fem::StructuralSystem system = reduced(setting).system;
  if (system.size() != 1)
    throw std::invalid_argument("model 'sdof' needs a reduction to one coordinate; this one keeps " +
                                std::to_string(system.size()));
  std::vector<Quantity> observed;
  auto model = std::make_unique<JointModel>();
  for (const Observation& observation : setting.observations) {
    if (observation.quantity == Quantity::force)
      throw std::invalid_argument(
          "model 'sdof' observes displacement, velocity or acceleration; found force");
    if (observation.quantity == Quantity::acceleration && options.flag("sensor_bias"))
      model->offsets.push_back({4, static_cast<Index>(observed.size())});
    observed.push_back(observation.quantity);
  }
  if (observed.empty()) throw std::invalid_argument("model 'sdof' needs at least one observed quantity");
  const double reading = system.outputs.coeff(0, 0);  // output per unit of the coordinate
  const double mass = system.mass.coeff(0, 0) / (reading * reading);
  const double stiffness = system.stiffness.assembled().coeff(0, 0) / (reading * reading);
  model->motion = std::make_shared<SingleDegreeOfFreedom>(mass, observed, !model->offsets.empty());
  model->unknowns = unknowns(mass, stiffness, setting.damping);
  model->unknown_places = {2, 3};
  model->mode_shapes = MatrixXd::Ones(1, 1);
  model->mode_frequencies = VectorXd::Constant(1, std::sqrt(stiffness / mass));
  model->equivalent_mass = mass;
  return model;
}

const bool registered = model_registry().add(
    {"sdof",
     "one degree of freedom: stiffness K and damping C unknown, mass known",
     "[inverse2009]",
     {{"sensor_bias", true, "",
       "estimate the accelerometer's constant offset too, where acceleration is observed"}},
     {},
     make});

}  // namespace
}  // namespace beamid::experiments
