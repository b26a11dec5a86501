// The whole mesh in bands against the same as dense matrices (dense_continuum.hpp).
#include "experiments/models/banded/continuum_motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <complex>
#include <functional>
#include <numbers>
#include <random>

#include "fem/cantilever.hpp"
#include "filters/discrete_model.hpp"
#include "filters/filter.hpp"
#include "tests/experiments/models/banded/dense_continuum.hpp"

namespace beamid::experiments::continuum_motion_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using fem::BeamParameter;
using Kind = Drive::Kind;

constexpr double interval = 1e-3;

fem::Beam study_beam() {
  fem::Cantilever beam;
  beam.length = 1.10;
  beam.bending_stiffness = 2.12e11 * fem::rectangle_second_moment(0.060, 0.006);
  beam.mass_per_length = 3.055 / 1.10;
  beam.tip_mass = 0.36049;
  return beam;
}

struct Case {
  std::string name;
  fem::ParametricSystem equations;
  MotionDescription description;
};

void add_unknown(MotionDescription& description, const std::string& name, double guess, Drive drive,
                 Form form = Form::linear) {
  description.unknowns.push_back(
      {name, "", guess, 0.1 * std::abs(guess), form, -5.0 * std::abs(guess), 5.0 * std::abs(guess)});
  description.drives.push_back(drive);
}

// A beam with these properties unknown, alpha and beta too, and its first two modes damped by one unknown
// ratio and one that is known. Observed: everything there is, with drifting sensors or constant biases.
Case make(const std::string& name, const fem::Beam& beam, int elements,
          const std::vector<BeamParameter>& parameters, bool drift = false, Form form = Form::linear) {
  Case result{
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

// Beams that reach every branch: tip body, springs, dashpots, axial load, absorber, shear, regions.
std::vector<Case> cases() {
  using Quantity = BeamParameter::Quantity;
  const BeamParameter stiffness{Quantity::bending_stiffness, {}}, mass{Quantity::tip_mass, {}},
      region{Quantity::bending_stiffness, {{0.22, 0.44}}}, load{Quantity::axial_load, {}},
      root{Quantity::root_rotational_stiffness, {}}, inertia{Quantity::tip_rotary_inertia, {}};
  std::vector<Case> result;
  result.push_back(make("cantilever", study_beam(), 6, {stiffness, mass}));
  result.push_back(make("logarithmic", study_beam(), 10, {stiffness, mass}, true, Form::logarithmic));

  fem::Beam beam = study_beam();
  beam.dashpots = {{0.66, 2.0, 0.01}};
  beam.springs = {{0.33, 300.0, 0.0}};
  result.push_back(make("spring and dashpot", beam, 15, {stiffness, region}));

  beam = study_beam();
  beam.supports.clear();
  beam.springs = {{0.0, 1e6, 500.0}};
  beam.bodies[0].eccentricity = 0.01;
  beam.bodies[0].rotary_inertia = 1e-3;
  result.push_back(make("elastic root and eccentric body", beam, 10, {root, mass, inertia}));

  beam = study_beam();
  beam.axial_load = 100.0;
  result.push_back(make("axial load", beam, 10, {stiffness, load}, true));

  beam = study_beam();
  beam.absorbers = {{0.55, 0.1, 200.0, 0.3}};
  beam.segments[0].section.shear_stiffness = fem::Variation(2e5);
  beam.segments[0].section.rotary_inertia = fem::Variation(1e-3);
  result.push_back(make("shear and absorber", beam, 8, {stiffness, mass}));
  return result;
}

// A state with nothing zero, unknowns near their guess.
VectorXd state_of(const Case& given, unsigned seed) {
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

// Sensors of 0.1 mm, 10 mm/s, 0.5 m/s2.
filters::Noise quiet(const Case& given) {
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

std::pair<std::unique_ptr<filters::DiscreteModel>, std::unique_ptr<filters::DiscreteModel>> both(
    const Case& given) {
  return {discretise(std::make_shared<ContinuumMotion>(given.equations, given.description), interval, "pade",
                     quiet(given)),
          discretise(std::make_shared<test::DenseContinuum>(given.equations, given.description), interval,
                     "pade", quiet(given))};
}

// Of every column against its own size.
double difference(const MatrixXd& a, const MatrixXd& b) {
  double worst = 0.0;
  for (Index j = 0; j < a.cols(); ++j) {
    const double apart = (a.col(j) - b.col(j)).norm();
    const double relative = apart == 0.0 ? 0.0 : apart / b.col(j).norm();
    if (!(relative <= worst)) worst = relative;  // also what is not a number
  }
  return worst;
}

TEST(ContinuumMotion, StepsAndTangentsAreThoseOfTheDenseMatrices) {
  // Oracle: the dense scheme `pade` with dense matrices and their derivatives, itself tested by differences.
  for (const Case& given : cases()) {
    SCOPED_TRACE(given.name);
    const auto [banded, dense] = both(given);
    const VectorXd state = state_of(given, 4);
    for (const Index degree : {0, 1, 4}) {
      const VectorXd input = VectorXd::LinSpaced(2 * (degree + 1), -3.0, 5.0);
      VectorXd next, expected;
      MatrixXd tangent, expected_tangent;
      dense->linearised_transition(state, input, expected, expected_tangent);
      banded->linearised_transition(state, input, next, tangent);
      const Index n = given.equations.system.size();
      EXPECT_LT(difference(next.head(n), expected.head(n)), 1e-11);
      EXPECT_LT(difference(next.segment(n, n), expected.segment(n, n)), 1e-11);
      EXPECT_LT((next - expected).tail(next.size() - 2 * n).norm(), 1e-14 * expected.norm());
      EXPECT_LT(difference(tangent, expected_tangent), 1e-10);
    }
  }
}

TEST(ContinuumMotion, ReadingsAndTheirDerivativesAreThoseOfTheDenseMatrices) {
  // Oracle: y and dy/dz from the dense A and B, and from their derivatives.
  for (const Case& given : cases()) {
    SCOPED_TRACE(given.name);
    const auto [banded, dense] = both(given);
    const VectorXd state = state_of(given, 5), input = VectorXd::LinSpaced(2, -3.0, 5.0);
    VectorXd read, expected;
    MatrixXd jacobian, expected_jacobian;
    banded->output(state, input, read);
    dense->output(state, input, expected);
    EXPECT_LT(difference(read, expected), 1e-13);
    banded->output_jacobian(state, input, jacobian);
    dense->output_jacobian(state, input, expected_jacobian);
    EXPECT_LT(difference(jacobian.transpose(), expected_jacobian.transpose()), 1e-13);
    const StateLayout places = layout(given.description, given.equations.system.size());
    const auto count = static_cast<Index>(given.description.unknowns.size());
    for (const Index sensor : {Index{0}, Index{3}})
      for (Index j = places.unknowns; j < places.unknowns + count; ++j)
        EXPECT_NEAR(jacobian(sensor, j), expected_jacobian(sensor, j),
                    1e-9 * std::abs(expected_jacobian(sensor, j)))
            << given.description.unknowns[j - places.unknowns].name;
  }
}

TEST(ContinuumMotion, MovesContinuouslyAsTheDenseMatricesDo) {
  // Oracle: A x + B u.
  for (const Case& given : cases()) {
    SCOPED_TRACE(given.name);
    const ContinuumMotion banded(given.equations, given.description);
    const test::DenseContinuum dense(given.equations, given.description);
    const VectorXd state = state_of(given, 6), input = VectorXd::LinSpaced(2, -3.0, 5.0);
    VectorXd rate, expected;
    banded.rate(state, input, rate);
    dense.rate(state, input, expected);
    EXPECT_LT(difference(rate, expected), 1e-12);
  }
}

// What a filter estimates from a record of a motion in the first two modes, with the last belief's mean and
// deviations.
std::pair<VectorXd, VectorXd> identify(const Case& given, const std::string& filter_name,
                                       std::unique_ptr<filters::DiscreteModel> model,
                                       const MatrixXd& record) {
  const StateLayout places = layout(given.description, given.equations.system.size());
  const Index n = places.coordinates, q = static_cast<Index>(given.description.unknowns.size());
  const fem::Modes modes = fem::modes(given.equations.system, 2);
  const auto offsets = static_cast<Index>(places.offsets.size());
  VectorXd mean = VectorXd::Zero(places.size);
  MatrixXd factor = MatrixXd::Zero(places.size, 4 + q + offsets);
  for (Index i = 0; i < 2; ++i) {
    factor.col(2 * i).head(n) = 0.005 * modes.shape.col(i);
    factor.col(2 * i + 1).segment(n, n) = 0.005 * modes.angular_frequency[i] * modes.shape.col(i);
    mean.head(n) += 0.01 / static_cast<double>(1 + 9 * i) * modes.shape.col(i);
  }
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = given.description.unknowns[static_cast<std::size_t>(j)];
    mean[places.unknowns + j] = unknown.to_state(unknown.guess);
    factor(places.unknowns + j, 4 + j) = unknown.deviation / unknown.slope(mean[places.unknowns + j]);
  }
  for (Index k = 0; k < offsets; ++k)
    factor(places.offsets[static_cast<std::size_t>(k)].place, 4 + q + k) = 0.1;
  auto filter = filters::filter_registry().make(filter_name, {}, std::move(model));
  if (filter_name == "ekf")
    filter->reset({mean, factor * factor.transpose()});
  else
    filter->reset({mean, {}, factor});
  const VectorXd input = VectorXd::LinSpaced(2, 0.5, 1.0);
  for (Index k = 0; k < record.cols(); ++k) {
    filter->correct(record.col(k), input);
    filter->predict(input);
  }
  return {filter->belief().mean, filter->belief().deviations()};
}

// Noisy readings of a motion in the first two modes, the parameters 2 % off their guess.
MatrixXd record_of(const Case& given, filters::DiscreteModel& model) {
  const StateLayout places = layout(given.description, given.equations.system.size());
  const Index n = places.coordinates, samples = 100;
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  VectorXd state = VectorXd::Zero(places.size), next, read;
  const fem::Modes modes = fem::modes(given.equations.system, 2);
  state.head(n) = 0.012 * modes.shape.col(0) + 0.001 * modes.shape.col(1);
  for (std::size_t j = 0; j < given.description.unknowns.size(); ++j) {
    const Unknown& unknown = given.description.unknowns[j];
    state[places.unknowns + static_cast<Index>(j)] = unknown.to_state(unknown.guess * 1.02);
  }
  MatrixXd record(static_cast<Index>(given.description.observations.size()), samples);
  const VectorXd input = VectorXd::LinSpaced(2, 0.5, 1.0);
  for (Index k = 0; k < samples; ++k) {
    model.output(state, input, read);
    for (Index i = 0; i < record.rows(); ++i)
      record(i, k) = read[i] + std::sqrt(model.output_noise()(i, i)) * normal(generator);
    model.transition(state, input, next);
    state.swap(next);
  }
  return record;
}

void expect_equal_estimates(const Case& given, const std::string& oracle) {
  auto [banded, dense] = both(given);
  const MatrixXd record = record_of(given, *dense);
  const auto [mean, deviations] = identify(given, "low_rank_ekf", std::move(banded), record);
  const auto [expected, expected_deviations] = identify(given, oracle, std::move(dense), record);
  const StateLayout places = layout(given.description, given.equations.system.size());
  const Index n = places.coordinates, q = static_cast<Index>(given.description.unknowns.size());
  for (Index j = places.unknowns; j < places.unknowns + q; ++j) {
    EXPECT_NEAR(mean[j], expected[j], 1e-8 * std::abs(expected[j])) << j - places.unknowns;
    EXPECT_NEAR(deviations[j], expected_deviations[j], 1e-8 * expected_deviations[j]) << j - places.unknowns;
  }
  EXPECT_LT((mean - expected).head(n).norm(), 1e-8 * expected.head(n).norm());
  EXPECT_LT((mean - expected).segment(n, n).norm(), 1e-8 * expected.segment(n, n).norm());
}

TEST(ContinuumMotion, EstimatesAreThoseOfTheDenseMatrices) {
  // Oracle: the same filter on the dense scheme `pade`.
  for (const Case& given : cases()) {
    SCOPED_TRACE(given.name);
    expect_equal_estimates(given, "low_rank_ekf");
  }
}

TEST(ContinuumMotion, EstimatesAreThoseOfTheFilterThatCarriesTheWholeCovariance) {
  // Oracle: `ekf` on the dense scheme. It observes displacement and velocity: an acceleration is a small
  // difference of the coordinates, by which a covariance of all of them loses twice as many digits as its
  // factor.
  for (Case given : cases()) {
    SCOPED_TRACE(given.name);
    given.description.observations = {{Quantity::displacement}, {Quantity::velocity}};
    given.equations.system.outputs = fem::SparseMatrix(given.equations.system.outputs.topRows(2));
    expect_equal_estimates(given, "ekf");
  }
}

// A thousand elements in their first mode, undamped, nothing unknown.
struct FineMesh {
  Case given;
  fem::Modes modes;
  VectorXd state;
  double turn = 0.0;  // the angle by which the step R(i omega dt) turns the mode
};

FineMesh fine_mesh() {
  FineMesh mesh{{"fine", fem::assemble_parametric(study_beam(), 1000, {{"tip", 1.10}}, {}), {}}, {}, {}, 0.0};
  mesh.given.description.observations = {{Quantity::acceleration}};
  const fem::StructuralSystem& system = mesh.given.equations.system;
  mesh.modes = fem::modes(system, 1);
  mesh.state.setZero(2 * system.size());
  mesh.state.head(system.size()) = 0.01 * mesh.modes.shape.col(0);
  const std::complex<double> z(0.0, mesh.modes.angular_frequency[0] * interval);
  mesh.turn = std::arg((12.0 + 6.0 * z + z * z) / (12.0 - 6.0 * z + z * z));
  return mesh;
}

TEST(ContinuumMotion, FineMeshKeepsTheFrequencyAndTheEnergy) {
  // Oracle: R(i omega dt) in closed form for the exact frequency of the mesh. Assembled stiffness is wrong by
  // 5e-8 here, and damps with a ratio of 3e-7.
  FineMesh mesh = fine_mesh();
  const Index n = mesh.given.equations.system.size();
  const auto model =
      discretise(std::make_shared<ContinuumMotion>(mesh.given.equations, mesh.given.description), interval,
                 "pade", quiet(mesh.given));
  VectorXd next;
  const int steps = 1000;
  for (int k = 0; k < steps; ++k) {
    model->transition(mesh.state, {}, next);
    mesh.state.swap(next);
  }
  const VectorXd momentum = mesh.given.equations.system.mass * mesh.modes.shape.col(0) / 0.01;
  const double cosine = momentum.dot(mesh.state.head(n));
  const double sine = -momentum.dot(mesh.state.segment(n, n)) / mesh.modes.angular_frequency[0];
  EXPECT_NEAR(std::hypot(cosine, sine), 1.0, 1e-11);
  EXPECT_NEAR(std::remainder(std::atan2(sine, cosine) - steps * mesh.turn, 2.0 * std::numbers::pi), 0.0,
              1e-11);
}

TEST(ContinuumMotion, FineMeshReadsAccelerationsWithoutTheNoiseOfItsHighestModes) {
  // Oracle: -omega^2 q of the mode. Without smoothing rounding brings up to 1e-4 m/s2 here, and 1 m/s2 at a
  // tip without mass.
  FineMesh mesh = fine_mesh();
  const auto model =
      discretise(std::make_shared<ContinuumMotion>(mesh.given.equations, mesh.given.description), interval,
                 "pade", quiet(mesh.given));
  const double omega = mesh.modes.angular_frequency[0];
  const double tip = 0.01 * (mesh.given.equations.system.outputs * mesh.modes.shape.col(0))[0];
  VectorXd next, read;
  for (int k = 0; k < 500; ++k) {
    model->output(mesh.state, {}, read);
    EXPECT_NEAR(read[0], -omega * omega * tip * std::cos(k * mesh.turn), 1e-7) << k;
    model->transition(mesh.state, {}, next);
    mesh.state.swap(next);
  }
}

TEST(ContinuumMotion, KnowsWhichUnknownsKeepTheModeShapes) {
  // Oracle: shapes of the modes with another value of the parameter.
  using Quantity = BeamParameter::Quantity;
  fem::Beam sprung = study_beam(), loaded = study_beam();
  sprung.springs = {{0.33, 300.0, 0.0}};
  loaded.axial_load = 50.0;
  const BeamParameter stiffness{Quantity::bending_stiffness, {}}, mass{Quantity::tip_mass, {}},
      region{Quantity::bending_stiffness, {{0.22, 0.44}}}, load{Quantity::axial_load, {}};
  const std::vector<std::pair<fem::Beam, BeamParameter>> all{{study_beam(), stiffness}, {study_beam(), mass},
                                                             {study_beam(), region},    {sprung, stiffness},
                                                             {study_beam(), load},      {loaded, stiffness}};
  for (const auto& [beam, parameter] : all) {
    const fem::ParametricSystem equations = fem::assemble_parametric(beam, 10, {{"tip", 1.10}}, {parameter});
    MotionDescription description;
    description.reference = equations.values;
    const fem::StructuralSystem other =
        fem::assemble(with_value(beam, parameter, 1.5 * equations.values[0] + 10.0), 10, {{"tip", 1.10}});
    const MatrixXd first = fem::modes(equations.system, 3).shape, second = fem::modes(other, 3).shape;
    double turned = 0.0;
    for (Index i = 0; i < 3; ++i) {
      const double along = std::abs(first.col(i).normalized().dot(second.col(i).normalized()));
      turned = std::max(turned, std::sqrt(std::max(0.0, 1.0 - along * along)));
    }
    EXPECT_EQ(keeps_mode_shapes(equations, description), turned < 1e-7) << turned;
    if (keeps_mode_shapes(equations, description)) {
      description.forces = {0};
      EXPECT_FALSE(keeps_mode_shapes(equations, description));
    }
  }
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

TEST(ContinuumMotion, SaysWhatItCannotDo) {
  using testing::HasSubstr;
  const FineMesh mesh = fine_mesh();
  const auto fine = std::make_shared<ContinuumMotion>(mesh.given.equations, mesh.given.description);
  EXPECT_THAT(refusal([&] { discretise(fine, interval, "exponential", quiet(mesh.given)); }),
              HasSubstr("2000 coordinates; expected 'pade', or the reduction modal_truncation"));
  Case given = cases()[0];
  given.description.observations.pop_back();
  EXPECT_THAT(refusal([&] { ContinuumMotion(given.equations, given.description); }),
              HasSubstr("4 output rows for 3 observations"));
  given = cases()[0];
  given.description.observations[1].quantity = Quantity::force;
  EXPECT_THAT(refusal([&] { ContinuumMotion(given.equations, given.description); }),
              HasSubstr("an input is no observation"));
  given = cases()[0];
  given.description.forces = {7};
  EXPECT_THAT(refusal([&] { ContinuumMotion(given.equations, given.description); }),
              HasSubstr("input 7; expected one of the system's 3"));
  given = cases()[0];
  given.description.reference.conservativeResize(1);
  EXPECT_THAT(refusal([&] { ContinuumMotion(given.equations, given.description); }),
              HasSubstr("drives 1 properties; expected the 2"));
}

TEST(ContinuumMotion, StopsAtNumbersThatAreNone) {
  const Case given = cases()[2];
  const auto [banded, dense] = both(given);
  VectorXd state = state_of(given, 4), next;
  state[layout(given.description, given.equations.system.size()).unknowns] = std::nan("");
  EXPECT_THROW(banded->transition(state, VectorXd::Zero(2), next), std::runtime_error);
}

}  // namespace
}  // namespace beamid::experiments::continuum_motion_test
