#include "tests/experiments/models/banded/banded_cases.hpp"

#include <cmath>
#include <random>

#include "experiments/models/banded/continuum_motion.hpp"
#include "fem/beam.hpp"
#include "fem/matrix_system.hpp"
#include "fem/parametric_system.hpp"
#include "fem/structure.hpp"
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

constexpr double load_unless_described = 40.0;  // [N]

// A structure of two points with these properties unknown, alpha and beta too, and its first two modes damped
// by one unknown ratio and one that is known. Observed: everything there is, with drifting sensors or
// constant biases.
BandedCase case_of(const std::string& name, fem::ParametricSystem equations, bool drift = false,
                   Form form = Form::linear) {
  BandedCase result{name, std::move(equations), {}};
  fem::StructuralSystem& system = result.equations.system;
  MotionDescription& description = result.description;
  description.reference = result.equations.values;
  for (Index j = 0; j < description.reference.size(); ++j)
    add_unknown(description, "property",
                description.reference[j] != 0.0 ? description.reference[j] : load_unless_described,
                {Kind::property, j}, form);
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

BandedCase banded_case(const std::string& name, const fem::Beam& beam, int elements,
                       const std::vector<BeamParameter>& parameters, bool drift = false,
                       Form form = Form::linear) {
  return case_of(name,
                 fem::assemble_parametric(beam, elements, {{"middle", 0.55}, {"tip", 1.10}}, parameters),
                 drift, form);
}

BeamParameter factor(const std::string& name) {
  return {BeamParameter::Quantity::factor, {}, name};
}

// A portal of two columns and a girder with a hinged brace, a body and a dashpot.
fem::Frame portal() {
  fem::Section section;
  section.bending_stiffness = fem::Variation(200.0);
  section.mass_per_length = fem::Variation(3.0);
  section.axial_stiffness = fem::Variation(4e5);
  fem::Section tapered = section;
  tapered.bending_stiffness = fem::Variation::linear(200.0, 120.0);
  fem::Frame frame;
  frame.joints = {{0.0, 0.0, "foot"}, {1.5, 0.1, "other"}, {0.0, 1.0, "left"}, {1.5, 1.1, "right"}};
  frame.members = {{0, 2, tapered, false, false, 1.0, "columns"},
                   {1, 3, section, false, false, 1.0, "columns"},
                   {2, 3, section, false, false, 0.9, "girder"},
                   {0, 3, section, true, true, 1.0, "brace"}};
  frame.supports = {{0}, {1, true, true, false}};
  frame.bodies = {{2, 0.5, 0.01}};
  frame.dashpots = {{3, 2.0, 1.0, 0.1}};
  return frame;
}

// Two columns out of one plane, and what joins them.
fem::SpaceFrame portal_in_space() {
  fem::SpaceSection section;
  section.axial_stiffness = 4e5;
  section.bending_stiffness_y = 150.0;
  section.bending_stiffness_z = 220.0;
  section.torsional_stiffness = 90.0;
  section.mass_per_length = 3.0;
  section.torsional_inertia = 2e-3;
  fem::SpaceFrame frame;
  frame.joints = {{{0.0, 0.0, 0.0}, "foot"},
                  {{1.2, 0.3, 0.0}, "other"},
                  {{0.0, 0.1, 1.0}, "left"},
                  {{1.2, 0.4, 1.1}, "right"}};
  frame.members = {{0, 2, section}, {1, 3, section}, {2, 3, section}};
  frame.members[0].group = frame.members[1].group = "columns";
  frame.members[2].group = "girder";
  frame.supports = {{0}, {1}};
  return frame;
}

// Masses in a ring, each held, whose first and last are neighbours: no band. All masses, the springs of one
// half and the dashpots scale with parameters.
fem::MatrixSystem ring(int size) {
  fem::MatrixSystem system;
  const auto made = [&](double own, double between, int from, int to) {
    fem::Triplets entries;
    for (int i = from; i < to; ++i) {
      const int next = (i + 1) % size;
      entries.emplace_back(i, i, own + between);
      if (between == 0.0) continue;
      entries.emplace_back(next, next, between);
      entries.emplace_back(i, next, -between);
      entries.emplace_back(next, i, -between);
    }
    return fem::sparse(size, size, entries);
  };
  system.mass = made(0.5, 0.0, 0, size);
  system.stiffness = made(2e3, 3e4, 0, size);
  system.damping = made(0.2, 0.0, 0, size);
  system.parameters = {{"masses", 1.0, made(0.3, 0.0, 0, size), {}, {}},
                       {"half", 1.0, {}, {}, made(500.0, 2e4, 0, size / 2)},
                       {"dashpots", 1.0, {}, made(0.3, 0.8, 3, size / 2), {}}};
  for (int i = 0; i < size; ++i) system.labels.push_back("m" + std::to_string(i + 1));
  system.base_motion.setOnes(size);
  return system;
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
  result.push_back(banded_case("axial load about none", banded_beam(), 10, {stiffness, load}));
  return result;
}

std::vector<BandedCase> sparse_cases() {
  const std::vector<fem::Point> joints{{"left", 0.0, "left.x"}, {"right", 0.0, "right.x"}};
  const std::vector<fem::Point> masses{{"second", 0.0, "m2"}, {"seventh", 0.0, "m7"}};
  const std::vector<BeamParameter> of_ring{factor("masses"), factor("half"), factor("dashpots")};
  std::vector<BandedCase> result;
  result.push_back(case_of(
      "plane frame",
      fem::assemble_parametric(portal(), 5, joints, {factor("columns"), factor("girder"), factor("brace")})));
  result.push_back(
      case_of("space frame",
              fem::assemble_parametric(portal_in_space(), 3, joints, {factor("columns"), factor("girder")}),
              true, Form::logarithmic));
  result.push_back(case_of("matrices", fem::assemble_parametric(ring(14), masses, of_ring)));
  result.push_back(case_of("matrices, many masses", fem::assemble_parametric(ring(40), masses, of_ring)));
  return result;
}

std::vector<BandedCase> all_cases() {
  std::vector<BandedCase> result = banded_cases();
  for (BandedCase& sparse : sparse_cases()) result.push_back(std::move(sparse));
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
