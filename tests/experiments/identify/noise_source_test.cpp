// Noise from the record, and the batch estimate beside the filter. Oracle: what the records were simulated
// with.
#include "experiments/identify/engine/model_setting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/identify/engine/analysis.hpp"
#include "experiments/studies/identify/report.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::noise_source_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

const test::SimulatedBeam simulated;

// Oracle of the standard error: 1 / sqrt(2 N) of a noise level alone.
TEST(LikeliestNoise, IsTheRecordsWithinItsStandardError) {
  const Record record = simulated.record({Quantity::acceleration}, 0.02, 61);
  Experiment experiment = simulated.experiment();
  experiment.noise_method.name = "likelihood";
  const RecordIdentification found = identify_record(experiment, record);
  const double truth = 0.02 * 0.012 * std::pow(simulated.mode.angular_frequency(), 2);
  ASSERT_EQ(found.noise_relative_deviation.size(), 1);
  const double error = found.noise_relative_deviation[0];
  EXPECT_NEAR(error, 1 / std::sqrt(2.0 * static_cast<double>(record.size())), 0.05 * error);
  EXPECT_NEAR(found.noise_deviation[0], truth, 4 * error * truth);
  const auto json = report(experiment, record, "simulated.csv", found).values.at("noise").at(0);
  EXPECT_EQ(json.at("method"), "likelihood");
  EXPECT_EQ(json.at("standard_deviation_si"), found.noise_deviation[0]);
}

TEST(LikeliestNoise, IsRefusedWhereAllIsStated) {
  Experiment experiment = simulated.experiment();
  experiment.noise_method.name = "likelihood";
  experiment.noise[Quantity::acceleration] = 1.0;
  EXPECT_THROW(identify_record(experiment, simulated.record({Quantity::acceleration}, 0.02, 61)),
               std::invalid_argument);
}

// Oracle: the median absolute deviation of N normal numbers is known within 1.17 / sqrt(N).
TEST(NoiseBeforeTheEvent, IsThatOfTheQuietPart) {
  const Index quiet = 400, all = 2000;
  const double noise = 0.01;
  Record record;
  record.time = VectorXd::LinSpaced(all, 0, 0.005 * static_cast<double>(all - 1));
  record.samples = noise * standard_normal(all, 3, 0).transpose();
  record.channels = {{Quantity::acceleration, "tip"}};
  for (Index k = quiet; k < all; ++k) record.samples(0, k) += std::cos(0.1 * static_cast<double>(k - quiet));
  const VectorXd found = noise_before_event(record);
  ASSERT_EQ(found.size(), 1);
  EXPECT_NEAR(found[0], noise, 4 * 1.17 * noise / std::sqrt(static_cast<double>(quiet)));
}

TEST(NoiseBeforeTheEvent, IsRefusedWhereTheRecordStartsInMotion) {
  EXPECT_THROW(noise_before_event(simulated.record({Quantity::acceleration}, 0.001, 5)),
               std::invalid_argument);
}

// Both are maximum likelihood here, but for the filter's prior and linearisation.
TEST(BatchEstimate, AgreesWithTheFilterAndTheTruth) {
  const Record record = simulated.record({Quantity::acceleration}, 0.02, 62);
  Experiment experiment = simulated.experiment();
  experiment.estimator = "both";
  const RecordIdentification found = identify_record(experiment, record);
  ASSERT_TRUE(found.batch && found.batch->identification);
  EXPECT_EQ(found.batch->estimate.status, filters::BatchStatus::converged);
  const Identification &batch = *found.batch->identification, &filter = found.identification;
  EXPECT_NEAR(batch.found.stiffness, simulated.truth.stiffness, 4 * batch.stiffness_deviation);
  EXPECT_NEAR(batch.found.damping, simulated.truth.damping, 4 * batch.damping_deviation);
  EXPECT_NEAR(batch.found.stiffness, filter.found.stiffness, 0.5 * filter.stiffness_deviation);
  EXPECT_NEAR(batch.stiffness_deviation, filter.stiffness_deviation, 0.05 * filter.stiffness_deviation);
}

// A second mode, ten times as large at first, six times as fast.
TEST(HigherModes, AreKeptFromTheFilterWhereTheyAreLarge) {
  Record record = simulated.record({Quantity::acceleration}, 0.001, 63);
  EXPECT_FALSE(step_against_higher_modes(simulated.experiment(), record));
  const double w = 6.3 * simulated.mode.angular_frequency(), largest = record.samples.cwiseAbs().maxCoeff();
  for (Index k = 0; k < record.size(); ++k)
    record.samples(0, k) +=
        10 * largest * std::exp(-0.002 * w * record.time[k]) * std::cos(w * record.time[k]);
  const auto step = step_against_higher_modes(simulated.experiment(), record);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->name, "decimate");
  EXPECT_EQ(std::get<double>(step->options.values().at("factor")),
            std::floor(200 / (8 * simulated.truth.frequency_hz())));
}

}  // namespace
}  // namespace beamid::experiments::noise_source_test
