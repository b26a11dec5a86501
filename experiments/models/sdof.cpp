// One degree of freedom: state [x, v, K, C] with known mass M and, where acceleration is observed, its
// sensor's bias b,
//
//     x' = v,   v' = -(K x + C v) / M,   K' = C' = b' = 0
//
// Where a force f on the structure was measured, its mass is unknown too: [x, v, K, C, M, b] and
// v' = (e f - K x - C v) / M. An acceleration of the base enters as a force that grows with M and tells
// nothing of it.
//
// x is the displacement at the first observation. Observed at any place, where the first mode of the beam
// moves r times as much: displacement r x, velocity r v or acceleration r v' + b (absolute, with that of the
// base), in any mix.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/models/joint_model.hpp"
#include "experiments/models/motion/parametric_motion.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// One observed channel.
struct SdofChannel {
  Quantity quantity = Quantity::acceleration;
  double reading = 1.0;     // r
  double base_share = 1.0;  // of the base's acceleration that it shows
};

// What is known of the oscillator.
struct Known {
  double mass = 0.0;          // [kg]; the guess where it is unknown
  bool mass_unknown = false;  // asked about
  VectorXd forces;            // e: force on x per force measured (m); of the base acceleration e / M
  Index base = -1;            // which of them is an acceleration of the base
};

class SingleDegreeOfFreedom final : public filters::LinearMotion {
 public:
  SingleDegreeOfFreedom(Known known, std::vector<SdofChannel> observed, bool sensor_bias)
      : known_(std::move(known)),
        observed_(std::move(observed)),
        bias_(sensor_bias ? (known_.mass_unknown ? 5 : 4) : 0),
        parameters_(2 + (known_.mass_unknown ? 1 : 0) + (sensor_bias ? 1 : 0)) {}

  Index input_size() const override { return known_.forces.size(); }
  std::vector<filters::Label> state_labels() const override {
    std::vector<filters::Label> labels{
        {"displacement", "m"}, {"velocity", "m/s"}, {"stiffness", "N/m"}, {"damping", "N s/m"}};
    if (known_.mass_unknown) labels.push_back({"mass", "kg"});
    if (bias_ > 0) labels.push_back({"sensor_bias", "m/s2"});
    return labels;
  }
  std::vector<filters::Label> output_labels() const override {
    std::vector<filters::Label> labels;
    for (const SdofChannel& one : observed_)
      labels.push_back({to_string(one.quantity), si_unit(one.quantity)});
    return labels;
  }
  Index motion_size() const override { return 2; }
  Index parameter_size() const override { return parameters_; }

  void motion_matrix(const VectorXd& state, MatrixXd& matrix) const override {
    matrix.resize(2, 2);
    matrix << 0.0, 1.0, -state[2] / mass(state), -state[3] / mass(state);
  }
  void motion_matrix_derivative(const VectorXd& state, Index j, MatrixXd& matrix) const override {
    matrix.setZero(2, 2);
    if (j < 2) matrix(1, j) = -1.0 / mass(state);
    if (is_mass(j)) matrix.row(1) << state[2], state[3];
    if (is_mass(j)) matrix.row(1) /= mass(state) * mass(state);
  }
  void input_matrix(const VectorXd& state, MatrixXd& matrix) const override {
    matrix.setZero(2, input_size());
    for (Index i = 0; i < input_size(); ++i)
      matrix(1, i) = i == known_.base ? known_.forces[i] : known_.forces[i] / mass(state);
  }
  void input_matrix_derivative(const VectorXd& state, Index j, MatrixXd& matrix) const override {
    matrix.setZero(2, input_size());
    for (Index i = 0; is_mass(j) && i < input_size(); ++i)
      if (i != known_.base) matrix(1, i) = -known_.forces[i] / (mass(state) * mass(state));
  }

  void output(const VectorXd& state, const VectorXd& input, VectorXd& output) const override {
    output.resize(static_cast<Index>(observed_.size()));
    for (Index i = 0; i < output.size(); ++i) {
      const auto& [quantity, reading, base_share] = observed_[static_cast<std::size_t>(i)];
      if (quantity == Quantity::displacement) output[i] = reading * state[0];
      if (quantity == Quantity::velocity) output[i] = reading * state[1];
      if (quantity != Quantity::acceleration) continue;
      const double restored = (state[2] * state[0] + state[3] * state[1]) / mass(state);
      output[i] = reading * (pushed(state, input) - restored) + (bias_ > 0 ? state[bias_] : 0.0);
      if (known_.base >= 0 && input.size() > 0) output[i] += base_share * input[known_.base];
    }
  }
  void output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const override {
    jacobian.setZero(static_cast<Index>(observed_.size()), 2 + parameters_);
    for (Index i = 0; i < jacobian.rows(); ++i) {
      const auto& [quantity, reading, unused] = observed_[static_cast<std::size_t>(i)];
      if (quantity == Quantity::displacement) jacobian(i, 0) = reading;
      if (quantity == Quantity::velocity) jacobian(i, 1) = reading;
      if (quantity == Quantity::acceleration) {
        jacobian.row(i).head<4>() << -state[2], -state[3], -state[0], -state[1];
        jacobian.row(i) /= mass(state);
        if (known_.mass_unknown) {
          jacobian(i, 4) = (state[2] * state[0] + state[3] * state[1]) / (mass(state) * mass(state));
          for (Index k = 0; k < input.size(); ++k)
            if (k != known_.base) jacobian(i, 4) -= known_.forces[k] * input[k] / (mass(state) * mass(state));
        }
        jacobian.row(i) *= reading;
        if (bias_ > 0) jacobian(i, bias_) = 1.0;
      }
    }
  }

 private:
  Known known_;
  std::vector<SdofChannel> observed_;
  Index bias_;  // its place in the state; 0: none
  Index parameters_;

  double mass(const VectorXd& state) const { return known_.mass_unknown ? state[4] : known_.mass; }
  bool is_mass(Index j) const { return known_.mass_unknown && j == 2; }
  double pushed(const VectorXd& state, const VectorXd& input) const {
    double sum = 0.0;
    for (Index k = 0; k < input.size(); ++k)
      sum += (k == known_.base ? known_.forces[k] : known_.forces[k] / mass(state)) * input[k];
    return sum;
  }
};

// The beam's own stiffness and damping, to 30 % and to as much again, and its mass to 10 %, unless the prior
// or a parameter says otherwise.
std::vector<Unknown> unknowns(const Known& known, double stiffness, const ModelSetting& setting) {
  constexpr double stiffness_uncertainty = 0.3, mass_uncertainty = 0.1, usual_damping_ratio = 0.01;
  const Prior& prior = setting.prior;
  stiffness = prior.stiffness.value_or(stiffness);
  const double omega = std::sqrt(stiffness / known.mass);
  const bool described = !std::holds_alternative<fem::Undamped>(setting.damping);
  const double ratio = prior.damping_ratio.value_or(
      described ? fem::damping_ratios(setting.damping, VectorXd::Constant(1, omega))[0]
                : usual_damping_ratio);
  const double to_damping = 2.0 * omega * known.mass;
  std::vector<Unknown> unknowns{
      {"stiffness", "N/m", stiffness, prior.stiffness_deviation.value_or(stiffness_uncertainty * stiffness)},
      {"damping", "N s/m", ratio * to_damping, prior.damping_ratio_deviation.value_or(ratio) * to_damping}};
  if (known.mass_unknown) unknowns.push_back({"mass", "kg", known.mass, mass_uncertainty * known.mass});
  for (Unknown& unknown : unknowns) unknown.quantity = unknown.name;
  for (const ParameterChoice& choice : setting.parameters) {
    require_quantity(choice, {"stiffness", "damping", "mass"}, "sdof");
    const auto same = [&](const Unknown& unknown) { return unknown.quantity == choice.quantity; };
    const auto unknown = std::find_if(unknowns.begin(), unknowns.end(), same);
    if (unknown == unknowns.end())
      refuse(choice, "model 'sdof' determines its mass where a force was measured; this record has none");
    *unknown = unknown_of(choice, {unknown->guess, unknown->deviation / unknown->guess});
    if (unknown->form != Form::linear)
      refuse(choice,
             std::string("model 'sdof' has linear parameters only; found form ") + to_string(unknown->form));
  }
  return unknowns;
}

// Displacement at every observation per that at the first one, r (p), in the first mode of the beam as
// described: nearer to what sensors at several places read than the shape of any reduction.
VectorXd readings(const ModelSetting& setting) {
  constexpr double node = 1e-6;  // of the largest reading
  const MatrixXd rows = setting.system.outputs;
  if ((rows.rowwise() - rows.row(0)).isZero(0.0)) return VectorXd::Ones(rows.rows());
  const VectorXd seen = rows * fem::modes(setting.system, 1).shape.col(0);
  if (!(std::abs(seen[0]) > node * seen.cwiseAbs().maxCoeff())) {
    const std::string& name = setting.observations[0].name;
    throw std::invalid_argument("model 'sdof' is about the motion at its first channel" +
                                (name.empty() ? "" : " '" + name + "'") +
                                ", where the first mode does not move; expected another channel first");
  }
  return seen / seen[0];
}

std::unique_ptr<JointModel> make_sdof(const ModelSetting& setting, const filters::Options& options) {
  const fem::StructuralSystem system = reduced(setting).system;
  if (system.size() != 1)
    throw std::invalid_argument("model 'sdof' needs a reduction to one coordinate; this one keeps " +
                                std::to_string(system.size()));
  require_no_supports("sdof", setting);
  std::vector<SdofChannel> observed;
  std::vector<Index> accelerometers;
  auto model = std::make_unique<JointModel>();
  for (const Observation& observation : setting.observations) {
    if (is_input(observation.quantity) || observation.quantity == Quantity::strain ||
        is_angular(observation.quantity))
      throw std::invalid_argument(
          std::string("model 'sdof' observes displacement, velocity or acceleration; found ") +
          to_string(observation.quantity));
    if (observation.quantity == Quantity::acceleration && options.flag("sensor_bias"))
      accelerometers.push_back(static_cast<Index>(observed.size()));
    observed.push_back({observation.quantity});
  }
  if (observed.empty()) throw std::invalid_argument("model 'sdof' needs at least one observed quantity");
  const VectorXd factors = readings(setting), shares = base_shares(setting.system);
  for (std::size_t i = 0; i < observed.size(); ++i) {
    observed[i].reading = factors[static_cast<Index>(i)];
    observed[i].base_share = shares[static_cast<Index>(i)];
  }
  const double reading = system.outputs.coeff(0, 0);  // output per unit of the coordinate
  if (reading == 0.0)
    throw std::invalid_argument("model 'sdof': the reduction does not move its first channel");
  Known known;
  known.mass = system.mass.coeff(0, 0) / (reading * reading);
  const double stiffness = system.stiffness.assembled().coeff(0, 0) / (reading * reading);
  known.forces.resize(static_cast<Index>(setting.forces.size()));
  for (std::size_t i = 0; i < setting.forces.size(); ++i) {
    const Index input = setting.forces[i];
    const auto& names = setting.system.input_names;
    const bool base = input < static_cast<Index>(names.size()) && names[input] == "base_acceleration";
    if (base) known.base = static_cast<Index>(i);
    known.mass_unknown |= !base;
    known.forces[static_cast<Index>(i)] = system.inputs.coeff(0, input) / reading / (base ? known.mass : 1.0);
  }
  const Index unknown_count = known.mass_unknown ? 3 : 2;
  for (const Index channel : accelerometers) model->offsets.push_back({2 + unknown_count, channel});
  model->unknowns = unknowns(known, stiffness, setting);
  for (Index j = 0; j < unknown_count; ++j) model->unknown_places.push_back(2 + j);
  model->motion = std::make_shared<SingleDegreeOfFreedom>(known, observed, !model->offsets.empty());
  model->mode_shapes = MatrixXd::Ones(1, 1);
  model->mode_frequencies =
      VectorXd::Constant(1, std::sqrt(setting.prior.stiffness.value_or(stiffness) / known.mass));
  model->equivalent_mass = known.mass;
  return model;
}

const bool sdof_registered = model_registry().add(
    {"sdof",
     "one degree of freedom: stiffness K and damping C unknown, mass too where a force was measured",
     "[inverse2009]",
     {{"sensor_bias", true, "",
       "estimate the accelerometer's constant offset too, where acceleration is observed"}},
     {},
     make_sdof});

}  // namespace
}  // namespace beamid::experiments
