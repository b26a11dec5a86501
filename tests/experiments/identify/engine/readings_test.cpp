// What a run counts as information, alone and together with others. Oracles: half of the readings say half
// as much; one record's joint estimate is its own; two alike are twice one.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/joint_comparison.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/studies/identify/report.hpp"

namespace beamid::experiments::readings_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

const Progress silent = [](const std::string&) {};

Experiment cantilever(const std::string& noise) {
  Experiment e = read_experiment(TomlTable::parse(
      "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\n"
      "mass_kg = 3.055\nelements = 20\n[damping]\nratio = 0.005\n[simulation]\nduration_s = 6\n"
      "sampling_rate_hz = 100\nmodes = 1\nseed = 3\n[[sensors]]\nname = \"tip\"\nnoise_m_per_s2 = 0.05\n"
      "[model]\nname = \"beam\"\n[[parameters]]\nquantity = \"bending_stiffness\"\nguess_n_m2 = 225\n"
      "[[parameters]]\nquantity = \"damping_ratio\"\nguess = 0.004\n" +
          noise,
      "test.toml"));
  e.reductions = {parse_reduction("modal_truncation", "test")};
  e.filters = {e.filter};
  e.discretisations = {e.discretisation};
  return e;
}

Comparison identified(const Experiment& e, const Record& record) {
  return compare(e, measured_record("record", record), {}, silent);
}

TEST(ComparedRecord, CountsReadingsAndNotWhatWasFilledIn) {
  const Experiment e = cantilever("[noise]\nacceleration_m_per_s2 = 0.05\n");
  const Record whole = simulated_record(e, {}, silent).record;
  Record half = whole;
  for (Index k = 1; k < half.size(); k += 2) half.samples(0, k) = std::numeric_limits<double>::quiet_NaN();
  const ComparedRun all = compare(e, measured_record("whole", whole), {}, silent).runs[0],
                    part = compare(e, measured_record("half", half), {}, silent).runs[0];
  ASSERT_EQ(part.status, ComparedRun::Status::converged) << part.reason;
  for (std::size_t j = 0; j < all.parameters.size(); ++j) {
    // without what either interval is widened by for the noise at the mode
    const double of_part = part.parameters[j].estimate.deviation / part.interval_factor,
                 of_all = all.parameters[j].estimate.deviation / all.interval_factor;
    EXPECT_NEAR(of_part / of_all, std::sqrt(2.0), 0.03) << all.parameters[j].estimate.name;
    EXPECT_NEAR(of_part / *part.parameters[j].bound, 1.0, 0.05) << all.parameters[j].estimate.name;
  }
}

// Noise of a band about the mode: far denser there than white noise of its deviation.
Comparison with_noise_at_the_mode(std::uint64_t seed) {
  const Experiment e = cantilever("");
  Record record = simulated_record(e, {}, silent).record;
  const VectorXd white = standard_normal(record.size(), seed, 0);
  double low = 0;
  for (Index k = 0; k < record.size(); ++k) {
    low += 0.25 * (white[k] - low);
    record.samples(0, k) += 0.3 * low;
  }
  return identified(e, record);
}

TEST(JointComparison, OfOneRecordHasItsIntervalsWidenedByTheNoiseAtTheMode) {
  const Comparison one = with_noise_at_the_mode(1);
  ASSERT_EQ(one.runs[0].status, ComparedRun::Status::converged) << one.runs[0].reason;
  ASSERT_GT(one.runs[0].noise_ratio, 1.2);
  const JointComparison joint = joint_comparison({one});
  for (std::size_t j = 0; j < joint.parameters.size(); ++j) {
    const Estimate& alone = one.runs[0].parameters[j].estimate;
    EXPECT_NEAR(joint.parameters[j].deviation / alone.deviation, 1.0, 0.02) << alone.name;
  }
}

TEST(JointComparison, WithoutARunThatConvergedHasDiverged) {
  const Experiment e = cantilever("");
  Comparison lost = compare(e, measured_record("lost", simulated_record(e, {}, silent).record), {}, silent);
  lost.runs[0].status = ComparedRun::Status::diverged;
  lost.runs[0].reason = "its damping ratio is -2 %";
  const Results results = report(e, joint_comparison({lost, lost}));
  EXPECT_EQ(results.values.at("status"), "diverged");
}

}  // namespace
}  // namespace beamid::experiments::readings_test
