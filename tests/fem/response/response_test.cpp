// What all methods share: their list, and what they refuse.
#include "fem/response/response.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/fem/response/oscillator_system.hpp"

namespace beamid::response_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using test::one, test::oscillator;

std::string message(const fem::Loading& loading, const fem::TimeGrid& grid,
                    const fem::ResponseMethod& method = {}) {
  try {
    respond(oscillator(1.0, 1.0), fem::Undamped{}, loading, grid, method);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ResponseMethods, AreListedWithTheirSourcesAndOptions) {
  std::vector<std::string> names;
  for (const auto& method : fem::response_methods()) {
    names.push_back(method.name);
    EXPECT_FALSE(method.summary.empty());
    EXPECT_EQ(method.source.front(), '[');
    EXPECT_FALSE(method.options.empty());
  }
  EXPECT_THAT(names,
              testing::ElementsAre("arkode", "cvode", "generalised_alpha", "hht_alpha", "modal", "newmark"));
}

TEST(Respond, SaysWhatIsUnknown) {
  const fem::Loading at_rest;
  EXPECT_EQ(message(at_rest, {0.1, 3}, {"newmrak", {}}),
            "unknown response method 'newmrak'; known: arkode, cvode, generalised_alpha, hht_alpha, modal, "
            "newmark");
  EXPECT_EQ(message(at_rest, {0.1, 3}, {"newmark", {{"bta", 0.25}}}),
            "unknown option 'bta' of response method 'newmark'; known: beta, gamma");
  EXPECT_EQ(message(at_rest, {0.1, 3}, {"hht_alpha", {{"alpha", 0.2}}}),
            "hht_alpha: option 'alpha' is 0.2; expected -1/3 to 0");
}

TEST(Respond, SaysWhatIsWrongWithSizesAndTimes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message({}, {0.0, 3}), "response: interval is 0 s; expected a finite time above 0");
  EXPECT_EQ(message({}, {0.1, 0}), "response: 0 samples; expected at least 1");
  EXPECT_EQ(message({}, {0.1, 3, {3}}), "response: frame 3; expected 0 to 2");
  EXPECT_EQ(message({}, {0.1, 3, {2, 1}}), "response: frame 1 after 2; expected ascending ones");
  EXPECT_EQ(message({VectorXd::Zero(2), {}, {}}, {0.1, 3}),
            "response: initial displacement has 2 entries; expected 1");
  EXPECT_EQ(message({one(nan), {}, {}}, {0.1, 3}), "response: initial displacement is not finite");
  EXPECT_EQ(message({{}, {}, MatrixXd::Zero(2, 4)}, {0.1, 3}),
            "response: inputs are 2 x 4; expected 2 x 3 (inputs x samples)");
}

TEST(Respond, GivesEveryMethodTheSameStart) {
  // Oracle: the equation of motion at t = 0.
  fem::Loading loading{one(0.1), one(-0.3), MatrixXd::Zero(2, 5)};
  loading.inputs.row(0).setConstant(7.0);
  const auto system = oscillator(2.0, 50.0, 0.6);
  for (const auto& method : fem::response_methods()) {
    const auto response = respond(system, fem::Undamped{}, loading, {0.01, 5, {0}}, {method.name, {}});
    EXPECT_NEAR(response.displacement(0, 0), 0.1, 1e-16) << method.name;
    EXPECT_NEAR(response.velocity(0, 0), -0.3, 1e-15) << method.name;
    EXPECT_NEAR(response.acceleration(0, 0), (7.0 + 0.6 * 0.3 - 50.0 * 0.1) / 2.0, 1e-14) << method.name;
    EXPECT_NEAR(response.field_acceleration(0, 0), response.acceleration(0, 0), 1e-14) << method.name;
    EXPECT_EQ(response.time.size(), 5);
    EXPECT_NEAR(response.time[4], 0.04, 1e-17);
  }
}

}  // namespace
}  // namespace beamid::response_test
