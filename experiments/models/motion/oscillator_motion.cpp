#include "experiments/models/motion/oscillator_motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "experiments/models/motion/parametric_motion.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// One observed channel.
struct ObservedChannel {
  Quantity quantity = Quantity::acceleration;
  double reading = 1.0;  // r
  Index bias = -1;       // place of b in the state; -1: none
};

// What the motion is made of. Parameters are those of the law, and the mass after them.
struct Parts {
  std::shared_ptr<const OscillatorLaw> law;
  VectorXd fixed;                 // values of the parameters that are not asked about (k + 1)
  std::vector<Unknown> unknowns;  // q
  std::vector<Index> drives;      // parameter of each unknown (q)
  VectorXd forces;                // e (m); of the base acceleration per mass
  Index base = -1;
  VectorXd base_shares;                  // of its acceleration that each observation shows (p)
  std::vector<ObservedChannel> sensors;  // p

  Index first() const { return law->slips() ? 3 : 2; }  // place of the first eta
  Index states() const {
    Index size = first() + static_cast<Index>(unknowns.size());
    for (const ObservedChannel& sensor : sensors) size += sensor.bias >= 0 ? 1 : 0;
    return size;
  }
};

// x'' and its derivatives by the whole state.
struct Acceleration {
  double value = 0.0;
  VectorXd by_state;
  OscillatorForce force;
};

class OscillatorMotion final : public filters::ContinuousModel {
 public:
  explicit OscillatorMotion(Parts parts) : parts_(std::move(parts)) {}

  Index input_size() const override { return parts_.forces.size(); }
  std::vector<filters::Label> state_labels() const override {
    std::vector<filters::Label> labels{{"displacement", "m"}, {"velocity", "m/s"}};
    if (parts_.law->slips()) labels.push_back({"slip", "m"});
    for (const Unknown& unknown : parts_.unknowns)
      labels.push_back({unknown.name, unknown.unit.empty() ? "1" : unknown.unit});
    for (Index b = static_cast<Index>(labels.size()), i = 1; b < parts_.states(); ++b, ++i)
      labels.push_back({i == 1 ? "sensor_bias" : "sensor_bias_" + std::to_string(i), "m/s2"});
    return labels;
  }
  std::vector<filters::Label> output_labels() const override {
    std::vector<filters::Label> labels;
    for (const ObservedChannel& sensor : parts_.sensors)
      labels.push_back({to_string(sensor.quantity), si_unit(sensor.quantity)});
    return labels;
  }

  void rate(const VectorXd& state, const VectorXd& input, VectorXd& rate) const override {
    const Acceleration found = acceleration(state, input, false);
    rate.setZero(state.size());
    rate[0] = state[1];
    rate[1] = found.value;
    if (parts_.law->slips()) rate[2] = found.force.slip_rate;
  }
  void rate_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const override {
    const Acceleration found = acceleration(state, input, true);
    jacobian.setZero(state.size(), state.size());
    jacobian(0, 1) = 1.0;
    jacobian.row(1) = found.by_state;
    if (!parts_.law->slips()) return;
    jacobian.row(2).head<3>() << found.force.slip_by_displacement, found.force.slip_by_velocity,
        found.force.slip_by_slip;
    for (std::size_t j = 0; j < parts_.unknowns.size(); ++j)
      if (const Index drive = parts_.drives[j]; drive < parts_.fixed.size() - 1)
        jacobian(2, parts_.first() + static_cast<Index>(j)) =
            found.force.slip_by_parameter[drive] * slope(state, j);
  }

  void output(const VectorXd& state, const VectorXd& input, VectorXd& output) const override {
    const double acceleration_now = acceleration(state, input, false).value;
    output.resize(static_cast<Index>(parts_.sensors.size()));
    for (Index i = 0; i < output.size(); ++i) {
      const ObservedChannel& sensor = parts_.sensors[static_cast<std::size_t>(i)];
      if (sensor.quantity == Quantity::displacement) output[i] = sensor.reading * state[0];
      if (sensor.quantity == Quantity::velocity) output[i] = sensor.reading * state[1];
      if (sensor.quantity != Quantity::acceleration) continue;
      output[i] = sensor.reading * acceleration_now + (sensor.bias >= 0 ? state[sensor.bias] : 0.0);
      if (parts_.base >= 0 && input.size() > 0) output[i] += parts_.base_shares[i] * input[parts_.base];
    }
  }
  void output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const override {
    const Acceleration found = acceleration(state, input, true);
    jacobian.setZero(static_cast<Index>(parts_.sensors.size()), state.size());
    for (Index i = 0; i < jacobian.rows(); ++i) {
      const ObservedChannel& sensor = parts_.sensors[static_cast<std::size_t>(i)];
      if (sensor.quantity == Quantity::displacement) jacobian(i, 0) = sensor.reading;
      if (sensor.quantity == Quantity::velocity) jacobian(i, 1) = sensor.reading;
      if (sensor.quantity == Quantity::acceleration) jacobian.row(i) = sensor.reading * found.by_state;
      if (sensor.bias >= 0) jacobian(i, sensor.bias) = 1.0;
    }
  }

 private:
  Parts parts_;

  double slope(const VectorXd& state, std::size_t j) const {
    return parts_.unknowns[j].slope(state[parts_.first() + static_cast<Index>(j)]);
  }

  Acceleration acceleration(const VectorXd& state, const VectorXd& input, bool with_slopes) const {
    Acceleration found;
    VectorXd p = parts_.fixed;
    for (std::size_t j = 0; j < parts_.unknowns.size(); ++j)
      p[parts_.drives[j]] = parts_.unknowns[j].to_physical(state[parts_.first() + static_cast<Index>(j)]);
    const Index k = p.size() - 1;
    const double mass = p[k];
    found.force.by_parameter.setZero(k);
    found.force.slip_by_parameter.setZero(k);
    parts_.law->evaluate(state[0], state[1], parts_.law->slips() ? state[2] : 0.0, p, found.force);
    double pushed = -found.force.value, carried = 0.0;
    for (Index i = 0; i < input.size(); ++i)
      (i == parts_.base ? carried : pushed) += parts_.forces[i] * input[i];
    found.value = pushed / mass + carried;
    if (!with_slopes) return found;
    found.by_state.setZero(state.size());
    found.by_state[0] = -found.force.by_displacement / mass;
    found.by_state[1] = -found.force.by_velocity / mass;
    if (parts_.law->slips()) found.by_state[2] = -found.force.by_slip / mass;
    for (std::size_t j = 0; j < parts_.unknowns.size(); ++j) {
      const Index drive = parts_.drives[j];
      const double by = drive == k ? -pushed / (mass * mass) : -found.force.by_parameter[drive] / mass;
      found.by_state[parts_.first() + static_cast<Index>(j)] = by * slope(state, j);
    }
    return found;
  }
};

// What is asked of the terms, and what they are fixed at.
void take_terms(const std::string& model, const ModelSetting& setting,
                const std::vector<OscillatorTerm>& terms, Parts& parts) {
  std::vector<std::string> known;
  for (const OscillatorTerm& term : terms) known.push_back(term.quantity);
  for (const ParameterChoice& choice : setting.parameters) require_quantity(choice, known, model);
  std::vector<ParameterChoice> choices;
  std::vector<ParameterDefault> defaults;
  parts.fixed.resize(static_cast<Index>(terms.size()));
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const OscillatorTerm& term = terms[i];
    parts.fixed[static_cast<Index>(i)] = term.fixed;
    const auto chosen =
        std::find_if(setting.parameters.begin(), setting.parameters.end(),
                     [&](const ParameterChoice& choice) { return choice.quantity == term.quantity; });
    const bool named = chosen != setting.parameters.end();
    if (!named && !term.always && !(setting.parameters.empty() && term.by_itself)) continue;
    choices.push_back(named ? *chosen : ParameterChoice{term.quantity});
    defaults.push_back({term.guess, term.deviation / std::abs(term.guess)});
    parts.drives.push_back(static_cast<Index>(i));
  }
  for (std::size_t i = 0; i < setting.parameters.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (setting.parameters[i].quantity == setting.parameters[j].quantity)
        refuse(setting.parameters[i], setting.parameters[i].quantity + " is requested twice");
  parts.unknowns = unknowns_of(choices, defaults);
}

reduction::ReducedModel one_coordinate_of(const std::string& model, const ModelSetting& setting) {
  reduction::ReducedModel found = reduced(setting);
  if (found.system.size() != 1)
    throw std::invalid_argument("model '" + model + "' needs a reduction to one coordinate; this one keeps " +
                                std::to_string(found.system.size()));
  return found;
}

}  // namespace

ExpectedOscillator expected_oscillator(const std::string& model, const ModelSetting& setting) {
  constexpr double usual_damping_ratio = 0.01, usual_amplitude = 0.01;
  const fem::StructuralSystem system = one_coordinate_of(model, setting).system;
  const double reading = system.outputs.rows() > 0 ? system.outputs.coeff(0, 0) : 1.0;
  ExpectedOscillator expected;
  expected.mass = system.mass.coeff(0, 0) / (reading * reading);
  expected.stiffness = system.stiffness.assembled().coeff(0, 0) / (reading * reading);
  const double omega = std::sqrt(expected.stiffness / expected.mass);
  const bool described = !std::holds_alternative<fem::Undamped>(setting.damping);
  const double ratio =
      described ? fem::damping_ratios(setting.damping, VectorXd::Constant(1, omega))[0] : usual_damping_ratio;
  expected.damping = 2.0 * ratio * omega * expected.mass;
  expected.amplitude = usual_amplitude * (setting.continuum ? setting.continuum->structure.extent() : 1.0);
  return expected;
}

std::unique_ptr<JointModel> make_oscillator(const std::string& name, const ModelSetting& setting,
                                            std::shared_ptr<const OscillatorLaw> law,
                                            const std::vector<OscillatorTerm>& law_terms, bool sensor_bias) {
  constexpr double mass_uncertainty = 0.1;
  require_no_supports(name, setting);
  const MotionDescription sensors =
      describe_sensors(name, setting, {{"sensor_bias", sensor_bias}, {"sensor_drift", false}});
  const ExpectedOscillator expected = expected_oscillator(name, setting);
  const fem::StructuralSystem system = one_coordinate_of(name, setting).system;
  const double first = system.outputs.coeff(0, 0);
  Parts parts;
  parts.law = std::move(law);
  parts.base = sensors.base;
  if (parts.base >= 0) parts.base_shares = sensors.carried.col(parts.base);
  parts.forces.resize(static_cast<Index>(setting.forces.size()));
  bool pushed = false;
  for (Index i = 0; i < parts.forces.size(); ++i) {
    const double force = system.inputs.coeff(0, setting.forces[static_cast<std::size_t>(i)]) / first;
    parts.forces[i] = i == parts.base ? force / expected.mass : force;
    pushed |= i != parts.base;
  }
  std::vector<OscillatorTerm> terms = law_terms;
  terms.push_back({"mass", expected.mass, mass_uncertainty * expected.mass, pushed, pushed, expected.mass});
  for (const ParameterChoice& choice : setting.parameters)
    if (choice.quantity == "mass" && !pushed)
      refuse(choice,
             "model '" + name + "' determines its mass where a force was measured; this record has none");
  take_terms(name, setting, terms, parts);

  auto model = std::make_unique<JointModel>();
  Index place = parts.first();
  for (std::size_t j = 0; j < parts.unknowns.size(); ++j) model->unknown_places.push_back(place++);
  for (std::size_t i = 0; i < setting.observations.size(); ++i) {
    const Quantity quantity = setting.observations[i].quantity;
    if (quantity == Quantity::strain || is_angular(quantity))
      throw std::invalid_argument(fmt::format(
          "model '{}' observes displacement, velocity or acceleration; found {}", name, to_string(quantity)));
    ObservedChannel sensor{quantity, system.outputs.coeff(static_cast<Index>(i), 0) / first};
    if (quantity == Quantity::acceleration && sensors.sensor_bias) {
      sensor.bias = place++;
      model->offsets.push_back({sensor.bias, static_cast<Index>(i)});
    }
    parts.sensors.push_back(sensor);
  }
  if (parts.law->slips()) model->slips = {2};
  model->unknowns = parts.unknowns;
  model->mode_shapes = MatrixXd::Ones(1, 1);
  model->mode_frequencies = VectorXd::Constant(1, std::sqrt(expected.stiffness / expected.mass));
  model->equivalent_mass = expected.mass;
  model->motion = std::make_shared<OscillatorMotion>(std::move(parts));
  return model;
}

namespace {

class SpringAndDashpot final : public OscillatorLaw {
 public:
  explicit SpringAndDashpot(std::shared_ptr<const SpringLaw> spring) : spring_(std::move(spring)) {}

  bool slips() const override { return spring_->slips(); }
  // p = [K, C, ...], of the spring without C; behind the law's own stands the mass
  void evaluate(double x, double v, double s, const VectorXd& p, OscillatorForce& force) const override {
    const Index k = force.by_parameter.size();
    SpringVector own(k - 1);
    own << p[0], p.segment(2, k - 2);
    SpringForce spring(k - 1);
    spring_->evaluate(x, v, s, own, spring);
    force.value = spring.value + p[1] * v;
    force.by_displacement = spring.by_drift;
    force.by_velocity = p[1];
    force.by_slip = spring.by_slip;
    force.by_parameter << spring.by_parameter[0], v, spring.by_parameter.tail(k - 2);
    force.slip_rate = spring.slip_rate;
    force.slip_by_displacement = spring.slip_by_drift;
    force.slip_by_velocity = spring.slip_by_rate;
    force.slip_by_slip = spring.slip_by_slip;
    force.slip_by_parameter << spring.slip_by_parameter[0], 0.0, spring.slip_by_parameter.tail(k - 2);
  }

 private:
  std::shared_ptr<const SpringLaw> spring_;
};

}  // namespace

std::shared_ptr<const OscillatorLaw> spring_and_dashpot(std::shared_ptr<const SpringLaw> spring) {
  return std::make_shared<SpringAndDashpot>(std::move(spring));
}

}  // namespace beamid::experiments
