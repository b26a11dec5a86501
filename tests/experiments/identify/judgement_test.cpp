// The first lines of a result: what contradicts it, and why. Oracles: the closed form of a scheme, the other
// mode that was put in, the prior that was stated wrongly.
#include "experiments/identify/engine/record_identification.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/studies/identify/report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::judgement_test {
namespace {

using Eigen::Index;
using testing::AllOf, testing::HasSubstr, testing::IsEmpty, testing::Not;

const test::SimulatedBeam simulated;

RecordIdentification identified(const Experiment& experiment, const Record& record) {
  return identify_record(experiment, record);
}

std::string printed(const Experiment& experiment, const Record& record) {
  std::ostringstream text;
  print(text, report(experiment, record, "record.csv", identify_record(experiment, record)));
  std::string line = text.str();
  for (char& letter : line)
    if (letter == '\n') letter = ' ';
  return line;
}

TEST(Judgement, HasNothingToSayOfAGoodRecord) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const RecordIdentification r =
        identified(simulated.experiment(), simulated.record({Quantity::acceleration}, 0.01, seed));
    EXPECT_EQ(r.judgement.verdict, ComparedRun::Status::converged);
    EXPECT_THAT(texts(r.judgement.objections), IsEmpty()) << seed;
  }
}

// Cramer-Rao: 2 s behind the release, with noise of 0.4 of the amplitude, know the damping to about 100 %.
TEST(Judgement, SaysWhereTheDampingIsHardlyDetermined) {
  const Record record = simulated.record({Quantity::acceleration}, 0.4, 3).window(0, 2);
  const RecordIdentification r = identified(simulated.experiment(), record);
  ASSERT_FALSE(r.judgement.objections.empty());
  EXPECT_THAT(r.judgement.objections[0].text, HasSubstr("The damping ratio is poorly determined"));
}

// C_f / C - 1 by the closed form, with the sampling interval of 5 ms: 1200 %.
TEST(Judgement, NamesTheDiscretisationThatMakesTheDifference) {
  Experiment experiment = simulated.experiment();
  experiment.discretisation = "forward_euler";
  const Record record = simulated.record({Quantity::acceleration}, 0.01, 1);
  const RecordIdentification r = identified(experiment, record);
  EXPECT_EQ(r.judgement.verdict, ComparedRun::Status::contradicted);
  ASSERT_EQ(r.judgement.objections.size(), 1u);
  const Oscillator seen = seen_through("forward_euler", simulated.truth, 0.005);
  const std::string error = std::to_string(
      static_cast<int>(std::lround(percent(seen.damping, simulated.truth.damping) / 10.0)));  // three digits
  EXPECT_THAT(r.judgement.objections[0].text,
              AllOf(HasSubstr("disagree by +"), HasSubstr("forward_euler at 5 ms makes C 1"),
                    HasSubstr("too large"), HasSubstr("use exponential")));
  EXPECT_NEAR(percent(r.identification.found.damping, simulated.truth.damping), 10.0 * std::stod(error),
              50.0);
  const std::string text = printed(experiment, record);
  EXPECT_LT(text.find("Filter and modal analysis disagree"), text.find("samples from"));
  EXPECT_THAT(text, Not(HasSubstr("stationary: consistent")));
}

// omega dt = 1.15: the scheme's closed form grows.
TEST(Judgement, NamesAStepThatIsTooLong) {
  Record record = simulated.record({Quantity::acceleration}, 0.01, 1), thin;
  constexpr Index every = 11;
  thin.channels = record.channels;
  const Index count = record.size() / every;
  thin.time.resize(count), thin.samples.resize(1, count);
  for (Index k = 0; k < count; ++k)
    thin.time[k] = record.time[every * k], thin.samples(0, k) = record.samples(0, every * k);
  Experiment experiment = simulated.experiment();
  EXPECT_EQ(identified(experiment, thin).judgement.verdict, ComparedRun::Status::converged);
  experiment.discretisation = "runge_kutta_4";
  const RecordIdentification r = identified(experiment, thin);
  EXPECT_EQ(r.judgement.verdict, ComparedRun::Status::diverged);
  EXPECT_THAT(r.judgement.objections.at(0).text,
              AllOf(HasSubstr("DIVERGED: its damping ratio is -"),
                    HasSubstr("The step is too long; discretisation exponential")));
}

TEST(Judgement, NamesAPriorThatExcludesTheRecord) {
  Experiment experiment = simulated.experiment();
  experiment.filter.name = "adaptive_ekf";
  experiment.prior.damping_ratio = 0.05;
  experiment.prior.damping_ratio_deviation = 1e-6;  // surer than the record
  const RecordIdentification r = identified(experiment, simulated.record({Quantity::acceleration}, 0.01, 1));
  EXPECT_NE(r.judgement.verdict, ComparedRun::Status::converged);
  EXPECT_THAT(r.judgement.objections.at(0).text,
              HasSubstr("prior.damping_ratio, 0.05 +- 1e-06, excludes it"));
  EXPECT_EQ(report(experiment, simulated.record({Quantity::acceleration}, 0.01, 1), "r", r).values["status"],
            to_string(r.judgement.verdict));
}

// A mode with half the amplitude at 1.25 times the frequency, which beats with the first over the whole
// record.
TEST(Judgement, NamesAnotherMode) {
  Record record = simulated.record({Quantity::acceleration}, 0.002, 1);
  const double w = 1.25 * simulated.mode.angular_frequency(),
               half = 0.5 * record.samples.cwiseAbs().maxCoeff();
  for (Index k = 0; k < record.size(); ++k)
    record.samples(0, k) += half * std::exp(-0.02 * w * record.time[k]) * std::cos(w * record.time[k]);
  const RecordIdentification r = identified(simulated.experiment(), record);
  ASSERT_EQ(r.modal.companions.size(), 1u);
  EXPECT_NEAR(r.modal.damping_ratio, simulated.damping_ratio, 0.05 * simulated.damping_ratio);
  if (!r.judgement.objections.empty()) {
    EXPECT_THAT(r.judgement.objections[0].text, HasSubstr("another mode at"));
  }
}

// A line at 2 f of 0.3 of the amplitude that decays with the mode, as a clipped or quadratic reading has it.
TEST(Judgement, NamesAnOvertone) {
  Record record = simulated.record({Quantity::acceleration}, 0.002, 1);
  const double w = simulated.mode.angular_frequency(), part = 0.3 * record.samples.cwiseAbs().maxCoeff();
  for (Index k = 0; k < record.size(); ++k)
    record.samples(0, k) +=
        part * std::exp(-simulated.damping_ratio * w * record.time[k]) * std::cos(2.0 * w * record.time[k]);
  const auto slow =
      Eigen::seqN(Index{0}, record.size() / 6, Index{6});  // 33 Hz: no decimation takes 2 f away
  record.time = record.time(slow).eval();
  record.samples = record.samples(Eigen::all, slow).eval();
  const RecordIdentification r = identified(simulated.experiment(), record);
  ASSERT_FALSE(r.judgement.objections.empty());
  EXPECT_THAT(r.judgement.objections.back().text,
              HasSubstr("An overtone at 6.911 Hz, 2 times the frequency, has 30 %"));
}

// A filter that makes the motion grow, where the modal analysis had to fit a line at 2 f along.
TEST(Judgement, NamesAnOvertoneAsTheCauseOfADivergence) {
  const Record record = simulated.record({Quantity::acceleration}, 0.002, 1);
  RecordIdentification r = identified(simulated.experiment(), record);
  r.identification.found.damping *= -1;
  r.modal.companions = {{2 * r.modal.frequency_hz, r.modal.damping_ratio, 0.8 * r.modal.amplitude}};
  const Judgement judgement = judge(simulated.experiment(), record, r);
  EXPECT_EQ(judgement.verdict, ComparedRun::Status::diverged);
  EXPECT_THAT(judgement.objections.at(0).text,
              HasSubstr("An overtone at 6.911 Hz, 2 times the frequency, has 80 %"));
  r.modal.companions[0].frequency_hz = 1.4 * r.modal.frequency_hz;
  EXPECT_THAT(judge(simulated.experiment(), record, r).objections.at(0).text,
              HasSubstr("another mode at 4.84 Hz"));
}

// x'' + 2 z w x' + w^2 (x + mu x^3 / x0^2) = 0 at 3.6 Hz and 1 %, by Runge-Kutta of 16 steps a sample, with
// noise of 0.2 % of the first acceleration.
Record cubic_spring(double mu, std::uint64_t seed) {
  const double w = 2.0 * std::numbers::pi * 3.6, z = 0.01, step = 0.005 / 16.0;
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0.0, 0.002 * w * w * 0.01);
  Record record;
  record.channels = {{Quantity::acceleration, "tip"}};
  record.time = Eigen::VectorXd::LinSpaced(4000, 0.0, 19.995);
  record.samples.resize(1, 4000);
  Eigen::Vector2d x(0.01, 0.0);
  const auto rate = [&](const Eigen::Vector2d& at) {
    return Eigen::Vector2d(
        at[1], -2.0 * z * w * at[1] - w * w * (at[0] + mu * at[0] * at[0] * at[0] / (0.01 * 0.01)));
  };
  for (Index k = 0; k < record.time.size(); ++k) {
    record.samples(0, k) = rate(x)[1] + normal(engine);
    for (int i = 0; i < 16; ++i) {
      const Eigen::Vector2d a = rate(x), b = rate(x + 0.5 * step * a), c = rate(x + 0.5 * step * b),
                            d = rate(x + step * c);
      x += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
  }
  return record;
}

// Oracle: the damping ratio that was put in, 1 %. A model of one frequency found 1.5 to 3.7 %.
TEST(Judgement, AFrequencyThatFollowsTheAmplitudeIsNamed) {
  Experiment experiment = simulated.experiment();
  for (const double mu : {0.5, 0.1, -0.1, -0.3})
    for (const std::uint64_t seed : {1, 2}) {
      const RecordIdentification r = identified(experiment, cubic_spring(mu, seed));
      EXPECT_NE(r.judgement.verdict, ComparedRun::Status::converged) << mu;
      EXPECT_THAT(texts(r.judgement.objections),
                  testing::Contains(HasSubstr("The frequency follows the amplitude")))
          << mu;
    }
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RecordIdentification r = identified(experiment, cubic_spring(0.0, seed));
    EXPECT_EQ(r.judgement.verdict, ComparedRun::Status::converged);
    EXPECT_THAT(texts(r.judgement.objections),
                Not(testing::Contains(HasSubstr("The frequency follows the amplitude"))));
  }
}

TEST(Report, BeginsWithTheWarningsOfTheRecord) {
  Record record = simulated.record({Quantity::acceleration}, 0.01, 1);
  record.objections = {{"clipped", "Channel tip is clipped."}};
  const Experiment experiment = simulated.experiment();
  Results results = report(experiment, record, "record.csv", identify_record(experiment, record));
  lead_with(results, "", record);
  std::ostringstream shown;
  print(shown, results);
  const std::string text = shown.str();
  ASSERT_NE(text.find("Channel tip is clipped."), std::string::npos);
  EXPECT_LT(text.find("Channel tip is clipped."), text.find("samples from"));
}

TEST(Judgement, NamesTheConditionThatADivergedFilterFails) {
  Experiment experiment = simulated.experiment();
  experiment.noise = {{Quantity::displacement, 1e-14}};
  const Record record = simulated.record({Quantity::displacement}, 0.01, 9);
  const RecordIdentification r = identified(experiment, record);
  EXPECT_EQ(r.judgement.verdict, ComparedRun::Status::diverged);
  EXPECT_THAT(r.judgement.objections.at(0).text, HasSubstr("DIVERGED: sample "));
}

}  // namespace
}  // namespace beamid::experiments::judgement_test
