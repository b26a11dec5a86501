// The whole mesh, banded or sparse, against the same as dense matrices (dense_continuum.hpp).
#include "experiments/models/banded/continuum_motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fem/modes.hpp"
#include "tests/experiments/models/banded/banded_cases.hpp"
#include "tests/experiments/models/banded/dense_continuum.hpp"

namespace beamid::experiments::continuum_motion_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using fem::BeamParameter;

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
  for (const BandedCase& given : all_cases()) {
    SCOPED_TRACE(given.name);
    const auto [banded, dense] = banded_and_dense(given);
    const VectorXd state = banded_state(given, 4);
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
  for (const BandedCase& given : all_cases()) {
    SCOPED_TRACE(given.name);
    const auto [banded, dense] = banded_and_dense(given);
    const VectorXd state = banded_state(given, 5), input = VectorXd::LinSpaced(2, -3.0, 5.0);
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
  for (const BandedCase& given : all_cases()) {
    SCOPED_TRACE(given.name);
    const ContinuumMotion banded(given.equations, given.description);
    const test::DenseContinuum dense(given.equations, given.description);
    const VectorXd state = banded_state(given, 6), input = VectorXd::LinSpaced(2, -3.0, 5.0);
    VectorXd rate, expected;
    banded.rate(state, input, rate);
    dense.rate(state, input, expected);
    EXPECT_LT(difference(rate, expected), 1e-12);
  }
}

TEST(ContinuumMotion, KnowsWhichUnknownsKeepTheModeShapes) {
  // Oracle: shapes of the modes with another value of the parameter.
  using Quantity = BeamParameter::Quantity;
  fem::Beam sprung = banded_beam(), loaded = banded_beam();
  sprung.springs = {{0.33, 300.0, 0.0}};
  loaded.axial_load = 50.0;
  const BeamParameter stiffness{Quantity::bending_stiffness, {}}, mass{Quantity::tip_mass, {}},
      region{Quantity::bending_stiffness, {{0.22, 0.44}}}, load{Quantity::axial_load, {}};
  const std::vector<std::pair<fem::Beam, BeamParameter>> all{
      {banded_beam(), stiffness}, {banded_beam(), mass}, {banded_beam(), region},
      {sprung, stiffness},        {banded_beam(), load}, {loaded, stiffness}};
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
  BandedCase given = banded_cases()[0];
  given.description.observations.pop_back();
  EXPECT_THAT(refusal([&] { ContinuumMotion(given.equations, given.description); }),
              HasSubstr("4 output rows for 3 observations"));
  given = banded_cases()[0];
  given.description.observations[1].quantity = Quantity::force;
  EXPECT_THAT(refusal([&] { ContinuumMotion(given.equations, given.description); }),
              HasSubstr("an input is no observation"));
  given = banded_cases()[0];
  given.description.forces = {7};
  EXPECT_THAT(refusal([&] { ContinuumMotion(given.equations, given.description); }),
              HasSubstr("input 7; expected one of the system's 3"));
  given = banded_cases()[0];
  given.description.reference.conservativeResize(1);
  EXPECT_THAT(refusal([&] { ContinuumMotion(given.equations, given.description); }),
              HasSubstr("drives 1 properties; expected the 2"));
}

TEST(ContinuumMotion, StopsAtNumbersThatAreNone) {
  const BandedCase given = banded_cases()[2];
  const auto [banded, dense] = banded_and_dense(given);
  VectorXd state = banded_state(given, 4), next;
  state[layout(given.description, given.equations.system.size()).unknowns] = std::nan("");
  EXPECT_THROW(banded->transition(state, VectorXd::Zero(2), next), std::runtime_error);
}

}  // namespace
}  // namespace beamid::experiments::continuum_motion_test
