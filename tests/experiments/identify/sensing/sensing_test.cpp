// Virtual sensing on simulated tests, whose truth is known.
#include "experiments/identify/sensing/sensing.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"

namespace beamid::sensing_test {
namespace {

using namespace experiments;
using Eigen::Index;

// A cantilever with a tip mass; its first two modes are at 1.5 and 15 Hz.
const std::string mast = R"(
title = "mast"
[beam]
length_m = 2.0
width_m = 0.05
height_m = 0.012
youngs_modulus_pa = 210e9
density_kg_per_m3 = 7850
tip_mass_kg = 2.0
[damping]
law = "modal"
ratio = 0.01
[excitation]
kind = "random"
position_m = 2.0
amplitude_n = 20
frequency_hz = 100
[simulation]
duration_s = 10
sampling_rate_hz = 200
seed = 4
[[sensors]]
name = "top"
position_m = 2.0
noise_m_per_s2 = 0.05
[[sensors]]
name = "middle"
position_m = 1.2
noise_m_per_s2 = 0.05
[[unknown_forces]]
name = "gust"
position_m = 2.0
[[virtual_sensors]]
name = "root"
quantity = "strain"
position_m = 0
)";

const std::string gauge = R"(
[[sensors]]
name = "gauge"
quantity = "strain"
position_m = 0.5
noise_m_per_m = 2e-6
)";

Experiment experiment_of(const std::string& text) {
  return read_experiment(TomlTable::parse(text, "test"));
}

// The same under a force of 20 Hz, well within what the sensors follow.
std::string slower(std::string text) {
  const std::string fast = "frequency_hz = 100";
  return text.replace(text.find(fast), fast.size(), "frequency_hz = 20");
}

SensingStudy study_of(const std::string& text, const std::string& other = "",
                      const std::optional<Choice>& filter = {}) {
  const Experiment experiment = experiment_of(text);
  SensingRecord record = simulated_sensing(experiment, {}, {}, unwatched);
  const Experiment assumed = other.empty() ? experiment : experiment_of(other);
  return study_sensing(assumed, record, sensing_reduction(assumed, record.record.interval()), {}, unwatched,
                       filter);
}

TEST(Sensing, FindsTheForceAndTheRootsStrainAsWellAsItSays) {
  // Oracle: the simulated force and strain, integrated by the rig in many modes. 2000 samples of an error
  // that is correlated over some of them: its rms is known to about 5 %.
  const SensingStudy study = study_of(mast + gauge);
  ASSERT_TRUE(study.converged);
  EXPECT_FALSE(study.contradicted());
  EXPECT_EQ(study.unseen_constants, 0);
  for (const SensedHistory& one : study.histories) {
    ASSERT_TRUE(one.truth) << one.name;
    EXPECT_NEAR(one.error() / one.reported_error(), 1.0, 0.2) << one.name;
    EXPECT_FALSE(one.undetermined()) << one.name;
  }
  EXPECT_LT(study.histories[0].error(), 0.05 * study.histories[0].root_mean_square());
}

TEST(Sensing, GivesTheHistoriesOfAFilterThatKnowsNothingOfTheForce) {
  // Oracle: the simulated force and strain. The filter's process is wider than the force, so its errors are
  // smaller than reported, and no more than four times those of the smoother, which sees what comes later.
  const SensingStudy smoothed = study_of(slower(mast + gauge));
  const SensingStudy study =
      study_of(slower(mast + gauge), "", Choice{"gillijns_de_moor", {{"inputs", std::vector<double>{}}}});
  for (std::size_t i = 0; i < study.histories.size(); ++i) {
    const SensedHistory& one = study.histories[i];
    EXPECT_FALSE(one.contradicts_smoother()) << one.name;
    EXPECT_LT(one.error(), 1.3 * one.reported_error()) << one.name;
    EXPECT_LT(one.error(), 4.0 * smoothed.histories[i].error()) << one.name;
  }
}

TEST(Sensing, TakesAVirtualAccelerationFromAFilterWhoseForceHasFewerStates) {
  // Oracle: the simulated acceleration. The filter's walk has one state where the smoother's process has two,
  // so the offsets of accelerometers are elsewhere in its state. Its force is known to a seventh of the
  // smoother's, and so is the acceleration.
  const std::string asked = slower(mast + gauge) + R"(
[[virtual_sensors]]
name = "between"
quantity = "acceleration"
position_m = 1.0
)";
  const SensingStudy smoothed = study_of(asked);
  const SensingStudy study =
      study_of(asked, "", Choice{"gillijns_de_moor", {{"inputs", std::vector<double>{}}}});
  const SensedHistory& one = study.histories[1];
  ASSERT_EQ(one.name, "between");
  EXPECT_FALSE(one.contradicts_smoother());
  EXPECT_LT(one.error(), 1.3 * one.reported_error());
  EXPECT_LT(one.reported_error(), 10.0 * smoothed.histories[1].reported_error());
}

TEST(Sensing, SaysWhereAFilterLeavesTheSmoother) {
  const SensingStudy study = study_of(
      slower(mast + gauge), "", Choice{"dual_kf", {{"inputs", std::vector<double>{}}, {"coupled", true}}});
  EXPECT_TRUE(study.histories.back().contradicts_smoother());
}

TEST(Sensing, SaysThatAccelerationsDoNotSeeAConstantForce) {
  const SensingStudy study = study_of(mast);
  EXPECT_EQ(study.unseen_constants, 1);
}

TEST(Sensing, IsContradictedWhereASensorIsElsewhere) {
  std::string moved = slower(mast + gauge);
  const std::string place = "position_m = 1.2";
  moved.replace(moved.find(place), place.size(), "position_m = 1.6");
  const Experiment experiment = experiment_of(slower(mast + gauge)), assumed = experiment_of(moved);
  SensingRecord record = simulated_sensing(experiment, {}, {}, unwatched);
  record.record.channels[1].position = 1.6;
  const SensingStudy study =
      study_sensing(assumed, record, sensing_reduction(assumed, record.record.interval()), {}, unwatched);
  EXPECT_TRUE(study.contradicted());
}

TEST(Sensing, FindsStiffnessUnderAForceThatNobodyMeasured) {
  // Oracle: the beam simulated; within 3 of the deviations reported.
  const SensingStudy study = study_of(slower(mast + gauge), slower(mast + gauge) + R"(
[[parameters]]
quantity = "bending_stiffness"
guess_n_m2 = 1300
relative_deviation = 0.3
)");
  ASSERT_TRUE(study.converged) << study.failure;
  const SensedConstant& found = study.constants.front();
  const double truth = 210e9 * 0.05 * std::pow(0.012, 3) / 12.0;
  const double deviation = (found.upper_95 - found.lower_95) / (2.0 * 1.96);
  EXPECT_NEAR(found.value, truth, 3.0 * deviation);
  EXPECT_LT(deviation, 0.01 * truth);
}

}  // namespace
}  // namespace beamid::sensing_test
