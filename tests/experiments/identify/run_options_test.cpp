// What an identification tells of its run, and what it does when the filter fails.
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/studies/identify/report.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::run_options_test {
namespace {

using Eigen::Index;

const test::SimulatedBeam simulated;

// Oracle: the model is the truth: white innovations (0.1 % of records fail), as many combinations of the
// unknowns told as there are, as many counts in the histogram as samples.
TEST(Diagnostics, ComeWithEveryIdentification) {
  const Record record = simulated.record({Quantity::displacement, Quantity::acceleration}, 0.01, 43);
  const Experiment experiment = simulated.experiment();
  const RecordIdentification found = identify_record(experiment, record);
  ASSERT_TRUE(found.diagnostics);
  const auto json = report(experiment, record, "simulated.csv", found).values.at("diagnostics");
  EXPECT_EQ(json.at("log_likelihood"), found.identification.run.log_likelihood);
  ASSERT_EQ(json.at("whiteness").size(), 2u);
  for (const auto& output : json.at("whiteness"))
    EXPECT_GT(output.at("ljung_box_p_value").get<double>(), 0.001);
  EXPECT_EQ(json.at("information").at("rank"), 2);
  double counted = 0.0;
  for (const double count : json.at("innovation_histogram").at("counts")[0]) counted += count;
  EXPECT_EQ(counted, static_cast<double>(record.size()));
}

// Oracle: a noise said to be 1e-11 m/s2 where it is 0.06 ends the run that stops; the others reach the end
// and tell what they met.
TEST(OnFailure, GoesOnWhereItIsAskedTo) {
  const Record record = simulated.record({Quantity::acceleration}, 0.01, 9);
  Experiment experiment = simulated.experiment();
  experiment.noise = {{Quantity::acceleration, 1e-11}};
  ASSERT_TRUE(identify_record(experiment, record).identification.run.failure);
  experiment.on_failure = filters::OnFailure::inflate;
  const RecordIdentification found = identify_record(experiment, record);
  EXPECT_FALSE(found.identification.run.failure) << found.identification.run.failure->reason;
  EXPECT_FALSE(found.identification.run.events.empty());
  const auto values = report(experiment, record, "simulated.csv", found).values;
  ASSERT_EQ(values.at("events").size(), found.identification.run.events.size());
  EXPECT_EQ(values.at("events")[0].at("step"), found.identification.run.events[0].step);
  EXPECT_FALSE(values.at("events")[0].at("reason").get<std::string>().empty());
}

// Oracle: the record says as much of the first sample as of the last: K and C, which are constant without
// process noise, are smoothed to what the filter ends with; the last estimate is the filter's own.
TEST(Smoothed, TellsAtTheStartWhatTheFilterKnowsAtTheEnd) {
  const Record record = simulated.record({Quantity::displacement}, 0.01, 14).window(0, 4);
  for (const char* smoother : {"rts", "urts"}) {
    Experiment experiment = simulated.experiment();
    experiment.smoother = smoother;
    const RecordIdentification found = identify_record(experiment, record);
    ASSERT_EQ(static_cast<Index>(found.smoothed.size()), record.size());
    const filters::Gaussian& last = found.identification.run.last;
    const Eigen::VectorXd deviation = last.deviations();
    EXPECT_EQ(found.smoothed.back().mean, found.identification.run.filtered.back().mean);
    for (const Index i : {2, 3}) {
      EXPECT_NEAR(found.smoothed.front().mean[i], last.mean[i], 0.05 * deviation[i]) << smoother;
      EXPECT_NEAR(found.smoothed.front().deviations()[i], deviation[i], 0.05 * deviation[i]) << smoother;
    }
    const Results results = report(experiment, record, "simulated.csv", found);
    ASSERT_EQ(results.attachments.size(), 1u);
    EXPECT_EQ(results.attachments[0].files, std::vector<std::string>{"smoothed.csv"});
    EXPECT_EQ(results.figures.back().name, "smoothed_history");
  }
}

// Oracle: the same samples with the stamps before they were printed.
TEST(PrintedStamps, CountAsTheGridTheyWereRoundedFrom) {
  constexpr double rate = 256.0;
  std::string text = "time_s,displacement_m\n";
  Record exact = simulated.record({Quantity::displacement}, 0.01, 15).window(0, 4);
  for (Index k = 0; k < exact.size(); ++k) {
    exact.time[k] = static_cast<double>(k) / rate;
    char line[80];
    std::snprintf(line, sizeof(line), "%.3f,%.17g\n", exact.time[k], exact.samples(0, k));
    text += line;
  }
  const TemporaryFile file("rounded.csv", text);
  const Record rounded = read_record(file.path());
  EXPECT_DOUBLE_EQ(rounded.time_resolution, 1e-3);
  EXPECT_DOUBLE_EQ(rounded.window(1, 2).time_resolution, 1e-3);
  EXPECT_DOUBLE_EQ(measurements(rounded).time_resolution, 1e-3);

  Experiment experiment = simulated.experiment();  // 200 Hz became 256: so did the beam's frequency
  experiment.prior.stiffness = simulated.truth.stiffness * std::pow(rate / 200.0, 2);
  const RecordIdentification from_exact = identify_record(experiment, exact),
                             from_rounded = identify_record(experiment, rounded);
  const Identification &a = from_exact.identification, &b = from_rounded.identification;
  // the mean interval is that of the two ends, off by half of the last digit at most
  EXPECT_NEAR(b.found.frequency_hz() / a.found.frequency_hz(), 1.0, 1e-3 / 4.0);
  EXPECT_NEAR(b.found.damping_ratio(), a.found.damping_ratio(), 0.01 * a.damping_ratio_deviation);
}

}  // namespace
}  // namespace beamid::experiments::run_options_test
