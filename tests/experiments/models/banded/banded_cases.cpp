#include "tests/experiments/models/banded/banded_cases.hpp"

#include <cmath>
#include <random>

#include "experiments/models/banded/continuum_motion.hpp"
#include "fem/cantilever.hpp"
#include "tests/experiments/models/banded/dense_continuum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using fem::BeamParameter;
using Kind = Drive::Kind;

void add_unknown(MotionDescription& description, const std::string& name, double guess, Drive drive,
                 Form form = Form::linear) {
  description.unknowns.push_back(
      {name, "", guess, 0.1 * std::abs(guess), form, -5.0 * std::abs(guess), 5.0 * std::abs(guess)});
  description.drives.push_back(drive);
}

// A beam with these properties unknown, alpha and beta too, and its first two modes damped by one unknown
// ratio and one that is known. Observed: everything there is, with drifting sensors or constant biases.
BandedCase banded_case(const std::string& name, const fem::Beam& beam, int elements,
                       const std::vector<BeamParameter>& parameters, bool drift = false,
                       Form form = Form::linear) {
  BandedCase result{
      name, fem::assemble_parametric(beam, elements, {{"middle", 0.55}, {"tip", 1.10}}, parameters), {}};
  fem::StructuralSystem& system = result.equations.system;
  MotionDescription& description = result.description;
  description.reference = result.equations.values;
  for (Index j = 0; j < description.reference.size(); ++j)
    add_unknown(description, "property", description.reference[j], {Kind::property, j}, form);
  description.damped_modes = test::damped_modes(result.equations, {0.004, 0.01});
  description.damped_modes[0].unknown = static_cast<Index>(description.unknowns.size());
  add_unknown(description, "damping_ratio", 0.004, {Kind::damping_ratio, -1});
  add_unknown(description, "mass_damping", 0.2, {Kind::mass_damping, -1});
  add_unknown(description, "stiffness_damping", 1e-5, {Kind::stiffness_damping, -1});
  description.observations = {
      {Quantity::acceleration}, {Quantity::displacement}, {Quantity::velocity}, {Quantity::acceleration}};
  const MatrixXd rows = system.outputs;
  MatrixXd observed(4, rows.cols());
  observed << rows.row(1), rows.row(0), rows.row(1), rows.row(0);
  system.outputs = observed.sparseView();
  description.forces = {1, 2};  // at the tip, and the acceleration of the base
  description.base = 1;
  description.carried.setZero(static_cast<Index>(description.observations.size()), 2);
  description.carried.col(1).setOnes();
  description.sensor_bias = true;
  description.sensor_drift = drift;
  return result;
}

}  // namespace

fem::Beam banded_beam() {
  fem::Cantilever beam;
  beam.length = 1.10;
  beam.bending_stiffness = 2.12e11 * fem::rectangle_second_moment(0.060, 0.006);
  beam.mass_per_length = 3.055 / 1.10;
  beam.tip_mass = 0.36049;
  return beam;
}

std::vector<BandedCase> banded_cases() {
  using Property = BeamParameter::Quantity;
  const BeamParameter stiffness{Property::bending_stiffness, {}}, mass{Property::tip_mass, {}},
      region{Property::bending_stiffness, {{0.22, 0.44}}}, load{Property::axial_load, {}},
      root{Property::root_rotational_stiffness, {}}, inertia{Property::tip_rotary_inertia, {}};
  std::vector<BandedCase> result;
  result.push_back(banded_case("cantilever", banded_beam(), 6, {stiffness, mass}));
  result.push_back(banded_case("logarithmic", banded_beam(), 10, {stiffness, mass}, true, Form::logarithmic));

  fem::Beam beam = banded_beam();
  beam.dashpots = {{0.66, 2.0, 0.01}};
  beam.springs = {{0.33, 300.0, 0.0}};
  result.push_back(banded_case("spring and dashpot", beam, 15, {stiffness, region}));

  beam = banded_beam();
  beam.supports.clear();
  beam.springs = {{0.0, 1e6, 500.0}};
  beam.bodies[0].eccentricity = 0.01;
  beam.bodies[0].rotary_inertia = 1e-3;
  result.push_back(banded_case("elastic root and eccentric body", beam, 10, {root, mass, inertia}));

  beam = banded_beam();
  beam.axial_load = 100.0;
  result.push_back(banded_case("axial load", beam, 10, {stiffness, load}, true));

  beam = banded_beam();
  beam.absorbers = {{0.55, 0.1, 200.0, 0.3}};
  beam.segments[0].section.shear_stiffness = fem::Variation(2e5);
  beam.segments[0].section.rotary_inertia = fem::Variation(1e-3);
  result.push_back(banded_case("shear and absorber", beam, 8, {stiffness, mass}));
  return result;
}

VectorXd banded_state(const BandedCase& given, unsigned seed) {
  const StateLayout places = layout(given.description, given.equations.system.size());
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  VectorXd state(places.size);
  const Index n = places.coordinates;
  for (Index i = 0; i < places.size; ++i) state[i] = (i < n ? 1e-3 : 0.3) * normal(generator);
  for (std::size_t j = 0; j < given.description.unknowns.size(); ++j) {
    const Unknown& unknown = given.description.unknowns[j];
    state[places.unknowns + static_cast<Index>(j)] =
        unknown.to_state(unknown.guess * (1.0 + 0.1 * normal(generator)));
  }
  return state;
}

filters::Noise quiet_sensors(const BandedCase& given) {
  VectorXd variances(static_cast<Index>(given.description.observations.size()));
  for (Index i = 0; i < variances.size(); ++i) {
    const Quantity quantity = given.description.observations[static_cast<std::size_t>(i)].quantity;
    const double deviation = quantity == Quantity::displacement ? 1e-4
                             : quantity == Quantity::velocity   ? 1e-2
                                                                : 0.5;
    variances[i] = deviation * deviation;
  }
  return {{}, variances.asDiagonal()};
}

std::pair<std::unique_ptr<filters::DiscreteModel>, std::unique_ptr<filters::DiscreteModel>> banded_and_dense(
    const BandedCase& given) {
  return {discretise(std::make_shared<ContinuumMotion>(given.equations, given.description), banded_interval,
                     "pade", quiet_sensors(given)),
          discretise(std::make_shared<test::DenseContinuum>(given.equations, given.description),
                     banded_interval, "pade", quiet_sensors(given))};
}

}  // namespace beamid::experiments
