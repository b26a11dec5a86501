// SUNDIALS against exact modal superposition.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/assembly.hpp"
#include "fem/response/response.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"
#include "tests/fem/response/oscillator_system.hpp"

namespace beamid::adaptive_test {
namespace {

using Eigen::Index, Eigen::MatrixXd;
using test::one, test::oscillator, test::relative_error;

class AdaptiveMethod : public testing::TestWithParam<const char*> {};

TEST_P(AdaptiveMethod, FollowsAReleasedBeamWithinItsTolerance) {
  // Oracle: exact modal response. The tolerance is per step; errors add up to some hundred times as much.
  fem::Beam beam = test::steel_beam(0.36049);
  beam.dashpots = {{beam.length(), 0.2, 0.0, 0.0}};
  const auto system = assemble(beam, 10);
  const fem::RayleighDamping law{{3.0, 0.01}, {60.0, 0.02}};
  const fem::Loading loading{0.012 * static_shape(system), {}, {}};
  const fem::TimeGrid grid{1e-3, 1001, {500}};
  const auto exact = respond(system, law, loading, grid);
  double errors[2];
  for (int i = 0; i < 2; ++i) {
    const double tolerance = i == 0 ? 1e-5 : 1e-8;
    const auto response =
        respond(system, law, loading, grid,
                {GetParam(), {{"tolerance", tolerance}, {"absolute_tolerance", 1e-3 * tolerance}}});
    errors[i] = relative_error(response.displacement, exact.displacement);
    EXPECT_LT(errors[i], 100 * tolerance);
    EXPECT_LT(relative_error(response.velocity, exact.velocity), 3000 * tolerance);
    EXPECT_LT(relative_error(response.field_displacement, exact.field_displacement), 300 * tolerance);
  }
  EXPECT_LT(errors[1], 0.05 * errors[0]);
}

TEST_P(AdaptiveMethod, FollowsASampledForceWithinItsTolerance) {
  // Oracle: exact modal response to the same force, straight between its samples: a harmonic of 22 Hz sampled
  // at 500 Hz. Steps across the kinks at the samples would miss it by 5e-4.
  const auto system = assemble(test::steel_beam(0.36049), 10);
  const fem::RayleighDamping law{{3.0, 0.01}, {60.0, 0.02}};
  const fem::TimeGrid grid{2e-3, 251};
  fem::Loading loading{{}, {}, MatrixXd::Zero(system.inputs.cols(), grid.samples)};
  for (Index k = 0; k < grid.samples; ++k)
    loading.inputs(0, k) = std::sin(2.0 * std::numbers::pi * 22.0 * grid.interval * static_cast<double>(k));
  const auto exact = respond(system, law, loading, grid);
  for (const double tolerance : {1e-6, 1e-8}) {
    const auto response =
        respond(system, law, loading, grid,
                {GetParam(), {{"tolerance", tolerance}, {"absolute_tolerance", 1e-3 * tolerance}}});
    EXPECT_LT(relative_error(response.displacement, exact.displacement), 100 * tolerance);
  }
}

TEST_P(AdaptiveMethod, DoesNotStepAcrossAShortPulse) {
  // Oracle: exact modal response to the same pulse, three samples long after 500 samples of rest.
  const auto system = oscillator(1.0, 400.0, 0.4);
  fem::Loading loading{{}, {}, MatrixXd::Zero(2, 1000)};
  loading.inputs(0, 500) = loading.inputs(0, 501) = 30.0;
  const fem::TimeGrid grid{0.01, 1000};
  const auto exact = respond(system, fem::Undamped{}, loading, grid);
  const auto response = respond(system, fem::Undamped{}, loading, grid, {GetParam(), {}});
  EXPECT_LT(relative_error(response.displacement, exact.displacement), 1e-4);
}

TEST_P(AdaptiveMethod, NamesMethodTimeAndFlagWhenItFails) {
  // A cubic spring so far out that its force is infinite.
  auto system = oscillator(1.0, 400.0);
  system.nonlinear_forces = {{test::sparse(MatrixXd::Ones(1, 1)), 1.0, 0.0}};
  try {
    respond(system, fem::Undamped{}, {one(1e200), {}, {}}, {0.01, 10}, {GetParam(), {}});
    ADD_FAILURE() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::MatchesRegex(std::string(GetParam()) +
                                                    ": [A-Za-z]+ failed at 0.01 s: [A-Z]+_[A-Z_]+"));
  }
}

INSTANTIATE_TEST_SUITE_P(Sundials, AdaptiveMethod, testing::Values("arkode", "cvode"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace beamid::adaptive_test
