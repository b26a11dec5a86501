// What the argument rests on: specificity, covariances, predictions. Oracle, unless another is named: the
// numbers that a referee of the study computed independently, in a program of his own, to the digits he
// printed.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"
#include "tests/experiments/studies/paper/shared_outcome.hpp"

namespace beamid::experiments::paper::argument_test {
namespace {

using test::outcome;

constexpr double half_of_the_third_digit = 0.5e-3;

TEST(PaperPredictions, AreTheNumbersThatNeedNoDampingRatio) {
  const double damping[] = {0.502, 0.509, 0.514, 0.515, 0.516},
               points[] = {1.302, 1.086, 0.790, 0.650, 0.543}, least[] = {260, 217, 158, 130, 109},
               amplitude[] = {0.721, 0.761, 0.820, 0.849, 0.872};
  const auto& found = outcome().predictions;
  ASSERT_EQ(found.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(found[i].damping_difference, damping[i], half_of_the_third_digit) << i;
    EXPECT_NEAR(100.0 * found[i].damping_ratio_difference, points[i], half_of_the_third_digit) << i;
    EXPECT_NEAR(100.0 * found[i].least_relative_error, least[i], 0.6) << i;
    EXPECT_NEAR(found[i].amplitude_after_four_cycles, amplitude[i], half_of_the_third_digit) << i;
  }
}

TEST(PaperPredictions, AreToFirstOrderTheStiffnessTimesTheStep) {
  // Oracle: C_f - C = Meq w^2 dt and xi_f - xi = w dt / 2, corrections of (w dt)^2 / 12.
  for (const BeamOutcome& o : outcome().beams) {
    const Prediction found = predict(o.beam);
    const double w = o.beam.reference.angular_frequency(), dt = 1e-3;
    EXPECT_NEAR(found.damping_difference / (o.beam.reference.stiffness * dt), 1.0, w * w * dt * dt / 6.0);
    EXPECT_NEAR(found.damping_ratio_difference / (0.5 * w * dt), 1.0, w * w * dt * dt / 6.0);
  }
}

const DigitCase& digits(const std::string& data, const std::string& scheme, const std::string& observed) {
  for (const DigitCase& one : outcome().digits)
    if (one.data == data && one.scheme == scheme && one.observed == observed) return one;
  throw std::logic_error("not examined");
}

TEST(PublishedDigits, AreExaminedIn144Combinations) {
  EXPECT_EQ(outcome().digits.size(), 144u);
}

TEST(PublishedDigits, ComeFromForwardEulerAndOneRival) {
  const auto expect = [](const char* data, const char* scheme, const char* observed, double k, double c) {
    const DigitCase& found = digits(data, scheme, observed);
    EXPECT_TRUE(found.prints_the_published_digits()) << data << ' ' << scheme << ' ' << observed;
    EXPECT_NEAR(found.stiffness_error_percent, k, 0.5e-4) << data;
    EXPECT_NEAR(found.damping_error_percent, c, 1.0e-4) << data;  // one unit of his last digit
  };
  expect("linear_acceleration", "forward_euler", "x and v", -0.1337, 6.4108);
  expect("central_difference", "forward_euler", "x and v", -0.1308, 6.4139);
  expect("backward_euler", "implicit_midpoint", "x and v", -0.1348, 6.4091);
  EXPECT_NEAR(digits("exact", "forward_euler", "x and v").damping_error_percent, 6.4138, 0.5e-4);
  const DigitCase& average = digits("average_acceleration", "forward_euler", "x and v");
  EXPECT_NEAR(average.stiffness_error_percent, -0.1351, 0.5e-4);
  EXPECT_FALSE(average.prints_the_published_digits());
  for (const DigitCase& one : outcome().digits)
    if (one.prints_the_published_digits() && one.scheme != "forward_euler") {
      EXPECT_EQ(one.data, "backward_euler");
      EXPECT_EQ(one.scheme, "implicit_midpoint");
    }
}

TEST(DataGenerators, OfOneSchemeGiveItsFilterAnExactRecord) {
  // Oracle: a filter that moves as its data do has no bias.
  for (const auto& [data, scheme] :
       std::map<std::string, std::string>{{"exact", "exponential"},
                                          {"average_acceleration", "implicit_midpoint"},
                                          {"forward_euler", "forward_euler"},
                                          {"backward_euler", "backward_euler"}}) {
    ValidationSettings settings = bias_settings();
    settings.data = data;
    const Identification found = validate("ekf", scheme, settings);
    EXPECT_NEAR(percent(found.found.damping, settings.truth.damping), 0.0, 1e-6) << data;
  }
  EXPECT_THROW(generate_decay("guessed", validation_truth(), 1.0, 1e-3, 3), std::exception);
}

TEST(DataGenerators, OfRungeKuttaAddTheirOwnErrorToForwardEuler) {
  // Oracle: data that move by 1 + z + z^2/2 are lambda_f = lambda + lambda^2 dt / 2 to forward Euler.
  ValidationSettings settings = bias_settings();
  settings.data = "runge_kutta_2";
  const std::complex<double> lambda = settings.truth.eigenvalue();
  const Oscillator expected =
      Oscillator::from_eigenvalue(settings.truth.mass, lambda + 0.5 * lambda * lambda * settings.interval);
  const Identification found = validate("ekf", "forward_euler", settings);
  EXPECT_NEAR(found.found.damping / expected.damping, 1.0, 1e-8);
  EXPECT_NEAR(found.found.stiffness / expected.stiffness, 1.0, 1e-8);
}

double damping_error_at(const char* varied, double value) {
  for (const CovarianceCase& one : outcome().covariances.cases)
    if (one.varied == varied && one.value == value) return one.damping_error_percent;
  throw std::logic_error("not examined");
}

TEST(BiasAgainstCovariances, HasTheNumbersOfAnIndependentFilter) {
  const auto expect = [](const char* varied, double value, double error) {
    EXPECT_NEAR(damping_error_at(varied, value), error, 0.6e-3) << varied << ' ' << value;
  };
  expect("R of v [m2/s2]", 1e-3, 6.242);
  expect("R of v [m2/s2]", 1e-7, 6.416);
  expect("R of x [m2]", 1e-7, 6.304);
  expect("R of x [m2]", 1e-3, 6.476);
  expect("Q of x and v, per step", 1e-12, 6.411);
  expect("Q of x and v, per step", 1e-10, 6.185);
  expect("Q of x and v, per step", 1e-8, 3.555);
  expect("Q of x and v, per step", 1e-6, 2.951);
  expect("P0 of K and C", 1e3, 6.453);
  expect("P0 of K and C", 1e4, 6.412);
  expect("P0 of K and C", 1e5, 6.414);
  expect("P0 of K and C", 1e8, 6.414);
}

TEST(BiasAgainstCovariances, IsHalfWhereSingleStepsAreFitted) {
  // Oracle: C_f - C = K dt (1 - 4 xi^2) / 2 to first order; the referee's +3.14 %.
  const Oscillator truth = validation_truth();
  const double found = percent(seen_step_by_step(truth, 1e-3).damping, truth.damping);
  EXPECT_NEAR(found, 3.14, 0.005);
  EXPECT_NEAR(found, 50.0 * truth.stiffness * 1e-3 * (1.0 - 4.0 * 0.01) / truth.damping, 0.02);
}

TEST(BiasAgainstCovariances, IsTheStepByStepOneUnderProcessNoiseAndGoodReadings) {
  // Oracle: the closed form of a regression over single steps; R far below Q, so that every step is its own.
  ValidationSettings settings;
  settings.process_variance = 1e-6;
  settings.noise_variance = 1e-14;
  const Identification found = validate("ekf", "forward_euler", settings);
  EXPECT_NEAR(percent(found.found.damping, settings.truth.damping),
              percent(seen_step_by_step(settings.truth, 1e-3).damping, settings.truth.damping), 0.01);
}

TEST(TwoChannels, ShowTheFaultWhereNoiseIsThatOfTheSensors) {
  // Oracle: the referee's NIS of 1.1 and 4.3 against 0.9, at conditions he does not print; here the
  // direction: on one channel nothing shows, with R = 1e-5 nothing, with two good channels the exact filter
  // alone is consistent.
  for (const ChannelCase& one : outcome().channels) {
    if (one.assumed_variance > 0.0) {
      EXPECT_LT(one.euler_square, 0.1);
      continue;
    }
    EXPECT_NEAR(one.exact_square, 1.0, 0.03) << one.motion;
    EXPECT_NEAR(one.exact_correlation, 0.0, 0.05) << one.motion;
    if (one.observed == "x") {
      EXPECT_NEAR(one.euler_square / one.exact_square, 1.0, 1e-3) << one.motion;
    } else if (one.displacement_noise < 5e-5) {
      EXPECT_GT(one.euler_square, 1.5) << one.motion;
      EXPECT_GT(one.euler_correlation, 0.4) << one.motion;
    }
  }
}

TEST(StartOnTheLightestBeam, IsALotteryWithTheSettingsOf2009) {
  // Oracle: the referee's starts at samples 0 to 500 and K0 of 0.6 to 1.2 K: some lost, the others from -1 to
  // +37 % and beyond with the exact scheme; forward Euler, where not lost, at +650 to +667 % from a good
  // start.
  const StartOutcome& start = outcome().start;
  const auto lost_of = [](const std::vector<StartCase>& cases) {
    return std::count_if(cases.begin(), cases.end(), [](const StartCase& one) { return one.exact_lost; });
  };
  EXPECT_GE(lost_of(start.starts), 3);
  EXPECT_LT(lost_of(start.starts), 8);
  const StartCase& late = start.starts.back();
  EXPECT_EQ(late.sample, 500);
  EXPECT_NEAR(late.exact_error_percent, -1.0, 1.0);
  EXPECT_NEAR(late.euler_error_percent, start.euler_prediction_percent, 10.0);
}

TEST(SecondMode, MovesFasterThanRSaysOnThreeBeams) {
  // Oracle: 46, 21, 5.3, 2.3 and 1.1 mm/s, amplitude times frequency of the exact second mode.
  const double velocity[] = {46, 21, 5.3, 2.3, 1.1}, half_a_digit[] = {0.5, 0.5, 0.05, 0.05, 0.05};
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(1e3 * second_mode_velocity(outcome().beams[i].beam), velocity[i], half_a_digit[i]) << i;
}

TEST(ChainOf2009, CostsTheExactSchemeAFewPerCent) {
  // Oracle: +2.1, +1.5, +2.9, +6.0, +8.2 %, which the referee read from an earlier version's table.
  const double cost[] = {2.1, 1.5, 2.9, 6.0, 8.2};
  for (std::size_t i = 0; i < 5; ++i) {
    const BeamOutcome& o = outcome().beams[i];
    EXPECT_NEAR(percent(o.wide_processed.found.damping, o.beam.reference.damping), cost[i], 0.05) << i;
  }
}

TEST(Alternatives, ThatKeepThePoleKeepTheDamping) {
  // Oracle: a linear filter that has settled leaves a decay's eigenvalue as it is.
  for (const AlternativeCase& one : outcome().alternatives)
    if (one.name == "integrals by the rectangle rule") {
      EXPECT_LT(one.damping_error_percent.cwiseAbs().maxCoeff(), 0.01);
      EXPECT_NEAR(one.noisy_damping_error_percent[1], -82.0, 0.5);  // the referee's, on S(11.8)
    } else if (one.name == "displacement high-passed once more") {
      EXPECT_LT(one.damping_error_percent.cwiseAbs().maxCoeff(), 2.6);
      EXPECT_NEAR(one.noisy_damping_error_percent[1], -1560.0, 15.0);
    } else if (one.name.ends_with("transient omitted") || one.name.ends_with("taken for v and x")) {
      EXPECT_LT(one.damping_error_percent.cwiseAbs().maxCoeff(), 0.1) << one.name;
    }
}

TEST(LongerSteps, MoveForwardEulerAlongTheClosedForm) {
  // Oracle: the closed form from the exact scheme's result, to the noise that both share; the assumed 0.45 %.
  const StepOutcome& step = outcome().step;
  ASSERT_EQ(step.steps.size(), 5u);
  for (const StepCase& one : step.steps) {
    EXPECT_NEAR(one.euler_ratio / one.predicted_ratio, 1.0, 5e-3) << one.interval;
    EXPECT_NEAR(one.exact_ratio, 0.0045, 0.0045 * 0.01) << one.interval;
  }
  EXPECT_NEAR(step.extrapolated_ratio, 0.0045, 0.0045 * 0.02);
}

}  // namespace
}  // namespace beamid::experiments::paper::argument_test
