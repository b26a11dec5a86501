// One degree of freedom with known mass: state [x, v, K, C] and, where acceleration is observed, its sensor's
// bias b,
//
//     x' = v,   v' = -(K x + C v) / M,   K' = C' = b' = 0
//
// Observed: displacement x, velocity v or acceleration -(K x + C v) / M + b, in any mix.
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

std::unique_ptr<JointModel> make(const fem::StructuralSystem& system, const std::vector<Quantity>& observed,
                                 const filters::Options& options) {
  if (system.size() != 1)
    throw std::invalid_argument("model 'sdof' needs a reduction to one coordinate; this one keeps " +
                                std::to_string(system.size()));
  bool acceleration = false;
  for (const Quantity quantity : observed) {
    if (quantity == Quantity::force)
      throw std::invalid_argument(
          "model 'sdof' observes displacement, velocity or acceleration; found force");
    acceleration |= quantity == Quantity::acceleration;
  }
  if (observed.empty()) throw std::invalid_argument("model 'sdof' needs at least one observed quantity");
  const double reading = system.outputs.coeff(0, 0);  // output per unit of the coordinate
  const double mass = system.mass.coeff(0, 0) / (reading * reading);
  const bool sensor_bias = acceleration && options.flag("sensor_bias");
  return std::make_unique<JointModel>(
      JointModel{std::make_shared<SingleDegreeOfFreedom>(mass, observed, sensor_bias), mass});
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
