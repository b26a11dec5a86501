// One record at several steps. Oracles: the truth it was simulated from; the closed form of each scheme.
#include "experiments/studies/steps/steps.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/results/results.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::steps_test {
namespace {

using testing::Contains, testing::HasSubstr, testing::IsEmpty;
using Verdict = SchemeAtStep::Verdict;

const test::SimulatedBeam simulated;  // 3.4555 Hz, 0.45 %, 200 Hz

IdentificationRequest request(const Record& record) {
  IdentificationRequest one{"record.csv", simulated.experiment(), {}, {}};
  one.prepared.raw = one.prepared.record = record;
  return one;
}

StepsStudy studied(const Record& record, const std::vector<std::string>& schemes,
                   std::optional<int> steps = {}) {
  return study_steps({schemes, steps}, request(record), {}, unwatched);
}

Record acceleration(double noise) {
  return simulated.record({Quantity::acceleration}, noise, 4);
}

TEST(Steps, LieOnTheCurvesOfTheClosedForm) {
  // Oracle: seen_through() of the truth, not of what was identified; four digits of the damping ratio.
  const StepsStudy study =
      studied(acceleration(1e-5), {"forward_euler", "implicit_midpoint", "runge_kutta_2"});
  ASSERT_EQ(study.steps.size(), 3u);  // 58, 29, 14 samples a period
  EXPECT_THAT(texts(study.objections), IsEmpty());
  for (const RecordAtStep& step : study.steps)
    for (const SchemeAtStep& one : step.found) {
      ASSERT_TRUE(one.is_valid()) << one.discretisation << step.factor;
      const Oscillator seen = seen_through(one.discretisation, simulated.truth, step.interval);
      EXPECT_NEAR(one.found->damping_ratio / seen.damping_ratio(), 1.0, 1e-4)
          << one.discretisation << step.factor;
      EXPECT_NEAR(one.found->frequency_hz / seen.frequency_hz(), 1.0, 1e-6)
          << one.discretisation << step.factor;
      EXPECT_EQ(one.verdict, one.discretisation == "exponential" ? Verdict::exact : Verdict::biased);
    }
}

TEST(Steps, ExtrapolateToTheTruthWithoutTheClosedForm) {
  // Oracle: the truth; forward Euler is 5 to 22 percentage points off at these steps. xi_f = sin(w dt / 2) +
  // ... leaves (w dt)^3 / 48 / 8 = 2.1e-4 of the longest, 0.43 rad, behind three steps.
  const StepsStudy study = studied(acceleration(1e-5), {"forward_euler", "runge_kutta_2"});
  for (const std::size_t d : {1u, 2u}) {
    const auto limit = study.extrapolated(d);
    ASSERT_TRUE(limit);
    EXPECT_EQ(limit->steps, 3);
    EXPECT_NEAR(limit->damping_ratio, simulated.damping_ratio, 2.3e-4) << d;
    EXPECT_LT(std::abs(limit->damping_ratio - simulated.damping_ratio), limit->uncertainty) << d;
    EXPECT_NEAR(limit->frequency_hz / simulated.mode.frequency_hz(), 1.0, 1e-4) << d;
  }
}

TEST(Steps, KeepTheInnovationsAsTheyAre) {
  // Oracle: 1, of a consistent filter; the wrong scheme's are no worse than the exact one's.
  const StepsStudy study = studied(acceleration(0.01), {"forward_euler"});
  for (const RecordAtStep& step : study.steps) {
    EXPECT_NEAR(*step.found[0].mean_nis, 1.0, 0.15);
    EXPECT_NEAR(*step.found[1].mean_nis, *step.found[0].mean_nis, 0.01);
    EXPECT_EQ(step.found[1].verdict, Verdict::biased);
  }
}

TEST(Steps, ShowTheBiasInTheInnovationsOfTwoChannels) {
  // Oracle: forward Euler's velocity over displacement is w dt / 2 = 5 % off, noise 0.1 %: the innovations of
  // the velocity are as large as that to begin with.
  const StepsStudy study =
      studied(simulated.record({Quantity::displacement, Quantity::velocity}, 1e-3, 4), {"forward_euler"});
  ASSERT_TRUE(study.steps[0].found[1].mean_nis);
  EXPECT_GT(*study.steps[0].found[1].mean_nis, 5.0 * *study.steps[0].found[0].mean_nis);
  EXPECT_THAT(study.notes, Contains(HasSubstr("Several channels are observed")));
  std::ostringstream text;
  print(text, report(simulated.experiment(), study));
  EXPECT_THAT(text.str(), HasSubstr("innovations show the bias: their mean"));
  EXPECT_THAT(text.str(), testing::Not(HasSubstr("do not show a")));
}

TEST(Steps, BeginWithTheFirstSampleOfTheWindow) {
  Record whole = acceleration(1e-5);
  IdentificationRequest one = request(whole);
  one.experiment.format.window = {2.015, 9.0};
  one.prepared.record = whole.window(2.015, 9.0);
  const StepsStudy study = study_steps({{"forward_euler"}, {}}, one, {}, unwatched);
  ASSERT_GE(study.steps.size(), 3u);
  for (const RecordAtStep& step : study.steps) {
    EXPECT_NEAR(step.from, 2.015, 1e-9) << step.factor;
    EXPECT_LE(step.to, 9.0 + 1e-9);
    EXPECT_GT(step.to, 9.0 - step.interval - 1e-9);
  }
}

TEST(Steps, SayWhereAStepIsTooLongForItsScheme) {
  // Oracle: at 3.6 samples a period forward Euler takes 3.4555 Hz for 3.0 Hz, no motion of the record's.
  const StepsStudy study = studied(acceleration(1e-5), {"forward_euler"}, 8);
  ASSERT_EQ(study.steps.size(), 5u);
  const SchemeAtStep& last = study.steps.back().found[1];
  EXPECT_EQ(last.verdict, Verdict::invalid);
  EXPECT_FALSE(last.is_valid());
  EXPECT_THAT(texts(study.objections),
              Contains(HasSubstr("forward_euler at steps of 80 ms has no valid estimate")));
  EXPECT_THAT(study.notes,
              Contains(HasSubstr("5 of 8 steps: with the next there would be 1.81 samples a period")));
  EXPECT_EQ(report(simulated.experiment(), study).values["schemes"][1]["steps"][4]["found"], nullptr);
}

TEST(Steps, RefuseAMeasuredForce) {
  Record record = acceleration(1e-5);
  record.channels.push_back({Quantity::force, "hammer"});
  record.samples.conservativeResize(2, Eigen::NoChange);
  record.samples.row(1).setZero();
  EXPECT_THROW(studied(record, {"forward_euler"}), std::invalid_argument);
}

TEST(Steps, SayThatOtherMotionChangesWithTheStep) {
  // A second mode at 21.6 Hz with ten times the acceleration, which decimation takes out.
  Record record = acceleration(1e-4);
  const double size = 2.0 * record.samples.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < record.size(); ++k)
    record.samples(0, k) +=
        size * std::exp(-1.5 * record.time[k]) * std::cos(2.0 * M_PI * 21.6 * record.time[k]);
  const StepsStudy study = studied(record, {"forward_euler"});
  const bool sure = study.has_reference() && study.objections.empty() &&
                    std::abs(study.reference().damping_ratio / simulated.damping_ratio - 1.0) > 0.02;
  EXPECT_FALSE(sure) << study.reference().damping_ratio;
}

TEST(Steps, HaveNoReferenceWhereNothingDecays) {
  Record record = acceleration(1e-5);
  std::srand(3);
  record.samples.setRandom();
  try {
    const StepsStudy study = studied(record, {"forward_euler"});
    EXPECT_FALSE(study.has_reference());
    EXPECT_EQ(report(simulated.experiment(), study).values["status"], to_string(study.status));
  } catch (const std::invalid_argument& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("modal analysis"));
  }
}

TEST(OrderOf, IsThatOfTheScheme) {
  EXPECT_EQ(order_of("forward_euler"), 1);
  EXPECT_EQ(order_of("backward_euler"), 1);
  EXPECT_EQ(order_of("implicit_midpoint"), 2);
  EXPECT_EQ(order_of("runge_kutta_2"), 2);
  EXPECT_EQ(order_of("runge_kutta_4"), 4);
  EXPECT_EQ(order_of("pade"), 4);
  EXPECT_EQ(order_of("exponential"), 0);
}

PublishedDamping published(double ratio, double half_digit) {
  return {ratio, half_digit, "forward_euler", 31.0 / 51200.0, 11.2186, false, {}, {}};
}

TEST(PublishedDamping, OfForwardEulerIsNearlyTheStepLess) {
  // Oracle: xi_f - xi = w dt / 2 = 2.134 percentage points, to first order.
  const BehindPublished found = behind_published(published(0.034234, 5e-7));
  EXPECT_TRUE(found.is_possible());
  EXPECT_NEAR(found.truth.damping_ratio, 0.034234 - 0.02134, 5e-5);
  EXPECT_NEAR(found.upper - found.lower, 1e-6, 1e-8);
  EXPECT_NEAR(found.least, 0.02134, 2e-5);
  EXPECT_NEAR(*found.with_process_noise, 0.034234 - 0.5 * 0.02134, 5e-4);
}

TEST(PublishedDamping, IsImpossibleBelowWhatNoDampingGives) {
  const BehindPublished found = behind_published(published(0.0196, 5e-5));
  EXPECT_FALSE(found.is_possible());
  EXPECT_EQ(report(found).values["status"], "impossible");
}

TEST(PublishedDamping, IsAsExactAsItsLastDigit) {
  EXPECT_DOUBLE_EQ(half_digit_of("0.034"), 5e-4);
  EXPECT_DOUBLE_EQ(half_digit_of("0.0340"), 5e-5);
  EXPECT_DOUBLE_EQ(half_digit_of("3.4e-2"), 5e-4);
  EXPECT_DOUBLE_EQ(half_digit_of("1e-1"), 0.05);
  EXPECT_DOUBLE_EQ(half_digit_of(".5"), 0.05);
}

}  // namespace
}  // namespace beamid::experiments::steps_test
