// Samples that arrive one by one.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/stream/sample_source.hpp"
#include "experiments/identify/stream/streamed_identification.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::streaming_test {
namespace {

using Eigen::Index;

const test::SimulatedBeam simulated;

class EveryFilter : public testing::TestWithParam<const char*> {
 protected:
  EveryFilter() { experiment_.filter.name = GetParam(); }

  // The batch: one pass over the whole record.
  filters::FilterRun batch() const {
    const StreamStart prepared = stream_start(experiment_, record_);
    return filter_record(prepared.model, measurements(record_), prepared.settings,
                         filters::Keep::all_estimates);
  }

  filters::Sample sample(Index k) const { return {record_.time[k], record_.samples.col(k)}; }

  Experiment experiment_ = simulated.experiment();
  Record record_ = simulated.record({Quantity::displacement, Quantity::acceleration}, 0.01, 11).window(0, 4);
};

// Oracle: the batch run, to the last digit, and after every sample.
TEST_P(EveryFilter, HasTheNumbersOfTheBatch) {
  const filters::FilterRun whole = batch();
  StreamedIdentification stream(experiment_, record_);
  for (Index k = 0; k < record_.size(); ++k) {
    ASSERT_TRUE(stream.take_in(sample(k)));
    ASSERT_EQ(stream.running().estimate().mean, whole.filtered[static_cast<std::size_t>(k)].mean) << k;
  }
  EXPECT_EQ(stream.running().estimate().covariance, whole.last.covariance);
}

TEST_P(EveryFilter, RefusesAMeasuredForce) {
  Record forced = record_;
  forced.channels[1] = {Quantity::force, "hammer"};
  try {
    StreamedIdentification(experiment_, forced);
    ADD_FAILURE() << "no error";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("a stream takes free motion; found the measured input 'hammer'"),
              std::string::npos)
        << error.what();
  }
}

// Oracle: the batch run. The text of the state is what a file would hold. A filter that carries a factor of
// the covariance forms it anew: rounding, not more.
TEST_P(EveryFilter, GoesOnFromASavedState) {
  const filters::FilterRun whole = batch();
  const Index half = record_.size() / 2;
  StreamedIdentification first(experiment_, record_), second(experiment_, record_);
  for (Index k = 0; k < half; ++k) ASSERT_TRUE(first.take_in(sample(k)));
  second.resume(nlohmann::json::parse(first.save().dump()));
  for (Index k = half; k < record_.size(); ++k) ASSERT_TRUE(second.take_in(sample(k)));
  EXPECT_EQ(second.running().step(), record_.size());
  const Eigen::VectorXd error = second.running().estimate().mean - whole.last.mean,
                        deviation = whole.last.deviations();
  if (std::string(GetParam()) == "ekf")
    EXPECT_EQ(second.running().estimate().mean, whole.last.mean);
  else
    for (Index i = 0; i < error.size(); ++i) EXPECT_LT(std::abs(error[i]), 1e-6 * deviation[i]) << i;
}

INSTANTIATE_TEST_SUITE_P(Filters, EveryFilter, testing::Values("ekf", "ukf", "srukf"),
                         [](const auto& tested) { return std::string(tested.param); });

// Oracle: the batch with NaN at the same places.
TEST(Stream, LeavesOutWhatWasNotMeasured) {
  Record record = simulated.record({Quantity::displacement}, 0.01, 12).window(0, 2);
  const Experiment experiment = simulated.experiment();
  const StreamStart prepared = stream_start(experiment, record);
  StreamedIdentification stream(experiment, record);
  record.samples.middleCols(100, 20).setConstant(std::nan(""));
  const filters::FilterRun whole = filter_record(prepared.model, measurements(record), prepared.settings);
  for (Index k = 0; k < record.size(); ++k) stream.take_in({record.time[k], record.samples.col(k)});
  EXPECT_EQ(stream.running().estimate().mean, whole.last.mean);
}

// Oracle: the stiffness of the beam that was simulated.
TEST(Stream, FollowsTheBeamItself) {
  Experiment experiment = simulated.experiment();
  experiment.model = {"beam", model_registry().completed("beam", {})};
  const Record record = simulated.record({Quantity::acceleration}, 0.01, 13);
  StreamedIdentification stream(experiment, simulated.record({Quantity::acceleration}, 0.01, 14));
  for (Index k = 0; k < record.size(); ++k)
    ASSERT_TRUE(stream.take_in({record.time[k], record.samples.col(k)}));
  EXPECT_EQ(stream_header(stream),
            "time_s,bending_stiffness_n_m2,bending_stiffness_deviation_n_m2,damping_ratio,"
            "damping_ratio_deviation,mean_normalised_square,status\n");
  const auto stiffness = stream.shown()[0];
  const double truth =
      experiment.structure.beam().segments[0].section.bending_stiffness(0.0) / 1.1;  // assumed 10 % too stiff
  EXPECT_NEAR(stiffness.value, truth, 0.02 * truth);
  EXPECT_EQ(stream.status(), StreamedIdentification::Status::settled);
}

/// A stream of what happens to loggers: K and C at the end, as rows of beamid stream have them.
class Disturbed : public testing::Test {
 protected:
  Record record_ = simulated.record({Quantity::acceleration}, 0.01, 21);
  Experiment experiment_ = simulated.experiment();

  filters::Sample sample(Index k) const { return {record_.time[k], record_.samples.col(k)}; }

  StreamedIdentification streamed() const {
    StreamedIdentification stream(experiment_, simulated.record({Quantity::acceleration}, 0.01, 22));
    for (Index k = 0; k < record_.size(); ++k)
      EXPECT_TRUE(stream.take_in(sample(k))) << k << " " << testing::PrintToString(stream.news());
    return stream;
  }

  // The rows of the stream, where its state is saved before this sample and taken up again.
  std::string rows(Index split) const {
    const Record earlier = simulated.record({Quantity::acceleration}, 0.01, 22);
    auto stream = std::make_unique<StreamedIdentification>(experiment_, earlier);
    std::string text;
    for (Index k = 0; k < record_.size(); ++k) {
      if (k == split) {
        const auto saved = nlohmann::json::parse(stream->save().dump());
        stream = std::make_unique<StreamedIdentification>(experiment_, earlier);
        stream->resume(saved);
      }
      stream->take_in(sample(k));
      text += stream_row(record_.time[k], *stream);
    }
    return text;
  }

  // Oracle: the truth that was simulated, within four of the deviations that the rows show.
  static void expect_truth(const StreamedIdentification& stream) {
    const auto shown = stream.shown();
    const double factor = stream.interval_factor();
    EXPECT_LT(std::abs(shown[0].value - simulated.truth.stiffness), 4.0 * factor * shown[0].deviation);
    EXPECT_LT(std::abs(shown[1].value - simulated.truth.damping), 4.0 * factor * shown[1].deviation);
    EXPECT_LT(factor, 2.0);
    EXPECT_EQ(stream.status(), StreamedIdentification::Status::settled);
  }
};

// Before: C = -858 +- 2e-7 for 0.21, and no word.
TEST_F(Disturbed, OneSpikeIsLeftOut) {
  const double largest = record_.samples.cwiseAbs().maxCoeff();
  record_.samples(0, 1000) = 1e3 * largest;
  const StreamedIdentification stream = streamed();
  expect_truth(stream);
  EXPECT_EQ(stream.watch().left_out(), 1);
  EXPECT_EQ(stream.watch().starts(), 0);
  record_.samples(0, 1000) = std::nan("");  // oracle: the reading that was not there
  EXPECT_EQ(streamed().running().estimate().mean, stream.running().estimate().mean);
}

TEST_F(Disturbed, ASpikeBeforeTheFilterHasSettledIsForgotten) {
  for (const double size : {3.0, 1e3, 1e9}) {
    record_ = simulated.record({Quantity::acceleration}, 0.01, 21);
    record_.samples(0, 100) = size * record_.samples.cwiseAbs().maxCoeff();
    StreamedIdentification stream = streamed();
    expect_truth(stream);
    EXPECT_GT(stream.watch().starts(), 0) << size;
    EXPECT_FALSE(stream.news().empty());
  }
}

// The beam is released again in mid-record, from another deflection.
TEST_F(Disturbed, ANewReleaseStartsANewMotionAndKeepsWhatIsKnown) {
  const Record other = simulated.record({Quantity::acceleration}, 0.01, 23);
  record_.samples.rightCols(1000) = 0.7 * other.samples.middleCols(200, 1000);
  StreamedIdentification stream = streamed();
  expect_truth(stream);
  const double both = stream.interval_factor() * stream.shown()[0].deviation;
  record_ = record_.window(5.01, 10.0);
  const StreamedIdentification second = streamed();
  EXPECT_LT(both, 0.8 * second.interval_factor() * second.shown()[0].deviation);
}

// Ten times the noise of the earlier record: flagged in every row, and no tight interval is shown.
TEST_F(Disturbed, MoreNoiseThanExpectedIsNeverSettled) {
  record_ = simulated.record({Quantity::acceleration}, 0.1, 24);
  StreamedIdentification stream(experiment_, simulated.record({Quantity::acceleration}, 0.01, 22));
  for (Index k = 0; k < record_.size(); ++k) {
    stream.take_in(sample(k));
    ASSERT_NE(stream.status(), StreamedIdentification::Status::settled) << k;
  }
  EXPECT_GT(stream.interval_factor(), 7.0);
}

// Oracle: the first estimate, since noise says nothing. Before: 96 % of the rows settled, K = 386 +- 20 for
// 509 N/m in tutorial 2.
TEST_F(Disturbed, AtRestNothingIsDetermined) {
  const double noise = 0.01 * record_.samples.cwiseAbs().maxCoeff();
  const StreamedIdentification fresh(experiment_, simulated.record({Quantity::acceleration}, 0.01, 22));
  for (const std::uint64_t seed : {31, 32, 33, 34, 35}) {
    record_.samples = noise * standard_normal(record_.size(), seed, 1).transpose();
    StreamedIdentification stream(experiment_, simulated.record({Quantity::acceleration}, 0.01, 22));
    for (Index k = 0; k < record_.size(); ++k) {
      ASSERT_TRUE(stream.take_in(sample(k)));
      ASSERT_NE(stream.status(), StreamedIdentification::Status::settled) << seed << " " << k;
    }
    EXPECT_EQ(stream.status(), StreamedIdentification::Status::undetermined) << seed;
    EXPECT_FALSE(stream.saw_motion()) << seed;
    EXPECT_EQ(stream.shown()[0].value, fresh.shown()[0].value) << seed;
    EXPECT_EQ(stream.shown()[0].deviation, fresh.shown()[0].deviation) << seed;
  }
}

// Oracle: the truth that was simulated. What 5 s of noise taught the filter is not kept.
TEST_F(Disturbed, AHitAfterRestIsIdentifiedFromTheHitOn) {
  const double noise = 0.01 * record_.samples.cwiseAbs().maxCoeff();
  record_.samples.rightCols(1000) = record_.samples.leftCols(1000).eval();
  record_.samples.leftCols(1000) = noise * standard_normal(1000, 36, 1).transpose();
  StreamedIdentification stream(experiment_, simulated.record({Quantity::acceleration}, 0.01, 22));
  Index settled = 0;
  for (Index k = 0; k < record_.size(); ++k) {
    ASSERT_TRUE(stream.take_in(sample(k)));
    if (settled == 0 && stream.status() == StreamedIdentification::Status::settled) settled = k;
  }
  EXPECT_GT(settled, 1000);
  EXPECT_LT(settled, 1300);
  EXPECT_TRUE(stream.saw_motion());
  expect_truth(stream);
}

// A decay that sinks below the noise after half the record keeps what it said. Oracle: its frequency.
TEST_F(Disturbed, ADecayThatDiesOutStaysSettled) {
  const double amplitude = record_.samples.cwiseAbs().maxCoeff(), w = simulated.mode.angular_frequency();
  constexpr double ratio = 0.02;
  record_.samples = 0.01 * amplitude * standard_normal(record_.size(), 37, 1).transpose();
  for (Index k = 0; k < record_.size(); ++k)
    record_.samples(0, k) += amplitude * std::exp(-ratio * w * record_.time[k]) *
                             std::cos(w * std::sqrt(1.0 - ratio * ratio) * record_.time[k]);
  const StreamedIdentification stream = streamed();
  EXPECT_EQ(stream.status(), StreamedIdentification::Status::settled);
  const auto frequency = stream.shown()[2];
  ASSERT_EQ(frequency.name, "frequency");
  EXPECT_LT(std::abs(frequency.value - w / (2.0 * std::numbers::pi)),
            4.0 * stream.interval_factor() * frequency.deviation);
}

// Oracle: the same in one piece, wherever it is split; the state holds the alarm's counters.
TEST_F(Disturbed, GoesOnFromAStateOfAnyMoment) {
  record_.samples(0, 100) *= 1e3;
  record_.samples(0, 1200) *= 1e3;
  record_.samples.rightCols(500) *= -2.0;
  const std::string whole = rows(-1);
  for (const Index split : {1, 49, 101, 500, 777, 1201, 1502, 1503, 1504, 1505, 1600, 1999})
    EXPECT_EQ(rows(split), whole) << split;
}

TEST_F(Disturbed, GoesOnFromAStateOfRest) {
  const double noise = 0.01 * record_.samples.cwiseAbs().maxCoeff();
  record_.samples.leftCols(800) = noise * standard_normal(800, 38, 1).transpose();
  const std::string whole = rows(-1);
  for (const Index split : {1, 150, 400, 799, 803, 900, 1100}) EXPECT_EQ(rows(split), whole) << split;
}

TEST(Stream, RefusesAStateThatNoFilterHas) {
  const Record record = simulated.record({Quantity::displacement}, 0.01, 13).window(0, 2);
  StreamedIdentification stream(simulated.experiment(), record);
  for (Index k = 0; k < 300; ++k) stream.take_in({record.time[k], record.samples.col(k)});
  const nlohmann::json saved = stream.save();
  const auto refusal = [&](const char* key, const nlohmann::json& value) -> std::string {
    nlohmann::json changed = saved;
    changed[key] = value;
    try {
      stream.resume(changed);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(refusal("covariance", std::vector<double>(16, 0.0)),
            "a standard deviation of the state is 0; expected more than 0");
  EXPECT_EQ(refusal("step", 1e30), "step is 1e+30; expected a whole number from 1 to 1000000000000000");
  EXPECT_EQ(refusal("step", -3), "step is -3; expected a whole number from 1 to 1000000000000000");
  EXPECT_NE(refusal("mean", nlohmann::json::array()).find("mean has 0 numbers"), std::string::npos);
  EXPECT_NE(refusal("covariance", nlohmann::json::array()), "taken");
  EXPECT_NE(refusal("filter", nlohmann::json::array({nlohmann::json::array()})), "taken");
  EXPECT_NE(refusal("health", 3), "taken");
  EXPECT_EQ(refusal("time_s", saved["time_s"]), "taken");
}

TEST(Stream, RefusesAStateThatIsNotItsOwn) {
  const Record record = simulated.record({Quantity::displacement}, 0.01, 13).window(0, 2);
  Experiment experiment = simulated.experiment();
  StreamedIdentification ekf(experiment, record);
  EXPECT_THROW(ekf.save(), std::invalid_argument);
  ekf.take_in({0.0, record.samples.col(0)});
  const nlohmann::json saved = ekf.save();
  experiment.filter.name = "ukf";
  StreamedIdentification ukf(experiment, record);
  try {
    ukf.resume(saved);
    FAIL() << "nothing was thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "filter is \"ekf\"; expected \"ukf\"");
  }
  EXPECT_THROW(ekf.resume(nlohmann::json::object()), std::invalid_argument);
  experiment.filter.name = "adaptive_ekf";
  StreamedIdentification adaptive(experiment, record);
  adaptive.take_in({0.0, record.samples.col(0)});
  EXPECT_THROW(adaptive.save(), std::invalid_argument);
}

TEST(SampleLine, TakesNumbersAndGaps) {
  const filters::Sample sample = read_sample(" 0.5 ,+1.5e-3,, nan\r", 3, {"standard input", 3, 1});
  EXPECT_EQ(sample.time, 0.5);
  EXPECT_EQ(sample.output[0], 1.5e-3);
  EXPECT_TRUE(std::isnan(sample.output[1]));
  EXPECT_TRUE(std::isnan(sample.output[2]));
}

TEST(SampleLine, SaysWhatIsWrongAndWhere) {
  const auto message = [](const std::string& line) -> std::string {
    try {
      read_sample(line, 1, {"standard input", 3, 1});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message("0.5,one"),
            "standard input:3:5: 'one'; expected a number, or an empty field where none was measured");
  EXPECT_EQ(message("0.5"),
            "standard input:3:1: 1 fields; expected 2: a time and 1 output, parted by commas");
  EXPECT_EQ(message(",1"), "standard input:3:1: no time; expected seconds");
}

}  // namespace
}  // namespace beamid::experiments::streaming_test
