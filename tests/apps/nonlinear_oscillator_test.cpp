// Tutorial 11, run as a user runs it. Oracle: the parameters that its records were made with.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::nonlinear_oscillator_test {
namespace {

using nlohmann::json;

fs::path tutorial(const std::string& file) {
  return source("docs/tutorials/11_nonlinear_oscillator") / file;
}

json run(const std::string& words) {
  const Outcome outcome = Workplace().run(words + " --json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return outcome.code == 0 ? json::parse(outcome.out) : json();
}

// In deviations.
double distance(const json& parameter, double truth) {
  return (parameter.at("estimate").get<double>() - truth) / parameter.at("standard_deviation").get<double>();
}

TEST(NonlinearOscillator, FindsDuffingsSpringByEveryTangent) {
  const json results =
      run("compare --config '" + tutorial("duffing.toml").string() +
          "' --reduction rayleigh --discretisation runge_kutta_4 --discretisation runge_kutta_4_differences");
  ASSERT_EQ(results.at("runs").size(), 2u);
  for (const json& one : results.at("runs")) {
    EXPECT_EQ(one.at("status"), "converged");
    const json& found = one.at("parameters");
    EXPECT_LT(std::abs(distance(found.at("stiffness"), 500.0)), 3.0);
    EXPECT_LT(std::abs(distance(found.at("damping"), 0.4)), 3.0);
    EXPECT_LT(std::abs(distance(found.at("cubic_stiffness"), 2e4)), 3.0);
    // Efficient: no unbiased estimate does better.
    EXPECT_NEAR(found.at("cubic_stiffness").at("bound_ratio").get<double>(), 1.0, 0.05);
  }
  // Exact tangents and differences are one filter.
  const auto value = [&](int i) {
    return results.at("runs").at(i).at("parameters").at("cubic_stiffness").at("estimate").get<double>();
  };
  EXPECT_NEAR(value(0) / value(1), 1.0, 1e-6);
}

TEST(NonlinearOscillator, IsIdentifiedBySensitivitiesOfCvodes) {
  const json results = run("identify --config '" + tutorial("duffing.toml").string() + "' --window 0 2.5");
  const json& one = results.at("runs").at(0);
  EXPECT_EQ(one.at("discretisation"), "cvode");
  EXPECT_EQ(one.at("status"), "converged");
  EXPECT_LT(std::abs(distance(one.at("parameters").at("cubic_stiffness"), 2e4)), 3.0);
}

TEST(NonlinearOscillator, FindsHysteresis) {
  const json results = run("compare --config '" + tutorial("bouc_wen.toml").string() +
                           "' --reduction rayleigh --discretisation runge_kutta_4");
  const json& found = results.at("runs").at(0).at("parameters");
  const std::pair<const char*, double> truth[] = {
      {"stiffness", 500.0}, {"post_yield_ratio", 0.5}, {"hysteresis_beta", 4.0}, {"hysteresis_gamma", 2.0}};
  for (const auto& [name, value] : truth)
    EXPECT_NEAR(found.at(name).at("estimate").get<double>(), value, 0.05 * value) << name;
}

TEST(DampingLawOption, TellsFrictionAndQuadraticDamping) {
  const json results = run("identify --config '" + tutorial("rubbed.toml").string() + "' --damping-law auto");
  EXPECT_EQ(results.at("supported"), "both");
  const json& found = results.at("laws").at(3).at("parameters");
  EXPECT_LT(std::abs(distance(found.at("coulomb_friction"), 0.03)), 2.5);
  EXPECT_LT(std::abs(distance(found.at("quadratic_damping"), 0.6)), 2.5);
}

TEST(DampingLawOption, RefusesOtherLaws) {
  const Outcome outcome =
      Workplace().run("identify --config '" + tutorial("rubbed.toml").string() + "' --damping-law air");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, testing::HasSubstr("--damping-law is 'air'; expected auto, viscous, coulomb"));
}

// Oracle: damping ratios of independent fits over later and later windows, which rise with falling amplitude
// in impulse.lvm (0.00286 to 0.0038) and fall in massa1 (0.0145 to 0.0128): friction there, drag here.
TEST(DampingLawOption, TellsMeasuredBeamsApart) {
  const fs::path data = source("../shared/data"), massa = data / "unb-tip-mass/massa1_test1-1.txt";
  if (!fs::exists(massa)) GTEST_SKIP() << "the measured records are not here";
  const json tip = run("identify '" + massa.string() + "' --config '" +
                       source("docs/tutorials/03_your_own_file/massa1.toml").string() +
                       "' --window 0.308 2.4 --damping-law auto");
  EXPECT_EQ(tip.at("supported"), "quadratic");
  const json plain = run("identify '" + (data / "chowdhury-impulse/impulse.lvm").string() + "' --config '" +
                         tutorial("impulse.toml").string() + "' --window 4.105 9.105 --damping-law auto");
  EXPECT_EQ(plain.at("supported"), "coulomb");
}

}  // namespace
}  // namespace beamid::apps::nonlinear_oscillator_test
