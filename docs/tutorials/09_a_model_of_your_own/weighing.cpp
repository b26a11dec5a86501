// Weighing by vibration: a free oscillator whose stiffness K was measured by a static test, while its mass M
// and its damping C are unknown. State [x, v, M, C],
//
//     x' = v,   v' = -(K x + C v) / M,   M' = C' = 0
//
// Observed: displacement x, velocity v or acceleration v', in any mix.
#include <algorithm>
#include <beamid/experiments.hpp>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

namespace {

using namespace beamid;
using namespace beamid::experiments;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class Weighing final : public filters::LinearMotion {
 public:
  Weighing(double stiffness, std::vector<Quantity> observed)
      : stiffness_(stiffness), observed_(std::move(observed)) {}

  std::vector<filters::Label> state_labels() const override {
    return {{"displacement", "m"}, {"velocity", "m/s"}, {"mass", "kg"}, {"damping", "N s/m"}};
  }
  std::vector<filters::Label> output_labels() const override {
    std::vector<filters::Label> labels;
    for (const Quantity quantity : observed_) labels.push_back({to_string(quantity), si_unit(quantity)});
    return labels;
  }
  Index motion_size() const override { return 2; }     // x, v
  Index parameter_size() const override { return 2; }  // M, C

  void motion_matrix(const VectorXd& state, MatrixXd& matrix) const override {
    matrix.resize(2, 2);
    matrix << 0.0, 1.0, -stiffness_ / state[2], -state[3] / state[2];
  }
  void motion_matrix_derivative(const VectorXd& state, Index j, MatrixXd& matrix) const override {
    matrix.setZero(2, 2);
    if (j == 0) matrix.row(1) << stiffness_, state[3];
    if (j == 0) matrix.row(1) /= state[2] * state[2];
    if (j == 1) matrix(1, 1) = -1.0 / state[2];
  }
  // Its Jacobian is by central differences, since none is given.
  void output(const VectorXd& state, const VectorXd&, VectorXd& output) const override {
    output.resize(static_cast<Index>(observed_.size()));
    for (Index i = 0; i < output.size(); ++i) {
      const Quantity quantity = observed_[static_cast<std::size_t>(i)];
      if (quantity == Quantity::displacement) output[i] = state[0];
      if (quantity == Quantity::velocity) output[i] = state[1];
      if (quantity == Quantity::acceleration)
        output[i] = -(stiffness_ * state[0] + state[3] * state[1]) / state[2];
    }
  }

 private:
  double stiffness_;  // K [N/m]
  std::vector<Quantity> observed_;
};

// The beam as described gives the guesses: its equivalent mass to 30 %, a damping ratio of 1 % to as much
// again.
std::unique_ptr<JointModel> make(const ModelSetting& setting, const filters::Options& options) {
  const fem::StructuralSystem system = reduced(setting).system;
  if (system.size() != 1 || !setting.forces.empty() || !setting.parameters.empty())
    throw std::invalid_argument(
        "model 'weighing' needs a free decay, a reduction to one coordinate and no [[parameters]]");
  std::vector<Quantity> observed;
  for (const Observation& observation : setting.observations) observed.push_back(observation.quantity);
  const auto motion = {Quantity::displacement, Quantity::velocity, Quantity::acceleration};
  if (observed.empty() || !std::all_of(observed.begin(), observed.end(), [&](Quantity quantity) {
        return std::find(motion.begin(), motion.end(), quantity) != motion.end();
      }))
    throw std::invalid_argument("model 'weighing' observes displacement, velocity or acceleration");

  const double reading = system.outputs.coeff(0, 0);  // output per unit of the coordinate
  const double mass = system.mass.coeff(0, 0) / (reading * reading);
  const double assumed = system.stiffness.assembled().coeff(0, 0) / (reading * reading);
  const double given = options.number("stiffness"), stiffness = given > 0.0 ? given : assumed;
  const double damping = 2.0 * 0.01 * std::sqrt(stiffness * mass);

  auto model = std::make_unique<JointModel>();
  model->motion = std::make_shared<Weighing>(stiffness, observed);
  model->unknowns = {{"mass", "kg", mass, 0.3 * mass}, {"damping", "N s/m", damping, damping}};
  for (Unknown& unknown : model->unknowns) unknown.quantity = unknown.name;
  model->unknown_places = {2, 3};
  model->equivalent_mass = mass;
  model->mode_shapes = MatrixXd::Ones(1, 1);  // of the one coordinate: where its start is uncertain
  model->mode_frequencies = VectorXd::Constant(1, std::sqrt(stiffness / mass));
  return model;
}

const bool registered =
    model_registry().add({"weighing",
                          "one degree of freedom of known stiffness: mass M and damping C unknown",
                          "S. S. Rao: Mechanical Vibrations, 6th ed. Pearson, Hoboken 2018",
                          {{"stiffness", 0.0, "N/m", "K, as a static test found it; 0: that of the beam"}},
                          {},
                          make});

}  // namespace
