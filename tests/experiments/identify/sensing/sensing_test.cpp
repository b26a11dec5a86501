// Virtual sensing on simulated tests, whose truth is known.
#include "experiments/identify/sensing/sensing.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "filters/random.hpp"

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

TEST(Sensing, TakesAMeanForceFromTheOneSensorThatSeesIt) {
  // Oracle: superposition; a force that has always been there strains by -h/2 F (l - x) / (E I).
  // Accelerometers say nothing of it: what they predict of the gauge is right but for its mean. Before:
  // contradicted.
  constexpr double mean = 80.0;  // five deviations of the gust
  const double stiffness = 210e9 * 0.05 * std::pow(0.012, 3) / 12.0, strain = -0.006 * mean / stiffness;
  const Experiment experiment = experiment_of(slower(mast + gauge));
  SensingRecord record = simulated_sensing(experiment, {}, {}, unwatched);
  record.record.samples.row(2).array() += 1.5 * strain;
  record.sensors[0].array() += 2.0 * strain;
  record.forces[0].array() += mean;
  const SensingStudy study = study_sensing(
      experiment, record, sensing_reduction(experiment, record.record.interval()), {}, unwatched);
  ASSERT_TRUE(study.converged) << study.failure;
  EXPECT_FALSE(study.contradicted());
  EXPECT_TRUE(study.is_to_rely_on());
  for (const SensedHistory& one : study.histories) {
    EXPECT_LT(std::abs((one.mean - *one.truth).mean()), one.reported_error()) << one.name;
    EXPECT_LT(one.error(), 2.0 * one.reported_error()) << one.name;
  }
}

TEST(Sensing, IsContradictedWhereTheOneSensorThatSeesAMeanIsScaledWrongly) {
  const Experiment experiment = experiment_of(slower(mast + gauge));
  SensingRecord record = simulated_sensing(experiment, {}, {}, unwatched);
  record.record.samples.row(2) *= 1.5;
  const SensingStudy study = study_sensing(
      experiment, record, sensing_reduction(experiment, record.record.interval()), {}, unwatched);
  EXPECT_TRUE(study.contradicted());
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

TEST(Sensing, SaysWhatRestsOnTheZeroOfOneSensor) {
  // Oracle: of a cantilever under a constant force F at its end, strain h/2 F (l - x) / (E I) at x.
  const SensingStudy study = study_of(mast + gauge);
  ASSERT_EQ(study.sole_zeros.size(), 1u);
  const SoleZero& zero = study.sole_zeros[0];
  EXPECT_EQ(zero.name, "gauge");
  const double stiffness = 210e9 * 0.05 * std::pow(0.012, 3) / 12.0;
  const double force = zero.off * stiffness / (0.006 * 1.5);
  EXPECT_NEAR(std::abs(zero.shifts.back()), force, 0.02 * force);
  const double root = zero.off * 2.0 / 1.5;
  EXPECT_NEAR(std::abs(zero.shifts.front()), root, 0.02 * root);
  EXPECT_TRUE(study_of(mast).sole_zeros.empty());
}

// A shear building; the true stiffnesses k [N/m] or what is guessed.
std::string building(const std::string& stiffnesses, const std::string& noise) {
  return R"(
title = "building"
[chain]
masses_kg = [1000, 1000, 800]
heights_m = [3, 3, 3]
stiffnesses_n_per_m = )" +
         stiffnesses + R"(
[damping]
law = "modal"
ratio = 0.02
[reduction]
method = "none"
[excitation]
kind = "random"
position_m = 9
amplitude_n = 1000
frequency_hz = 12
[simulation]
duration_s = 15
sampling_rate_hz = 100
seed = 3
[[sensors]]
name = "a1"
position_m = 3
)" + noise +
         R"(
[[sensors]]
name = "a2"
position_m = 6
)" + noise +
         R"(
[[sensors]]
name = "a3"
position_m = 9
)" + noise +
         R"(
[[sensors]]
name = "d3"
quantity = "displacement"
position_m = 9
noise_m = 1e-5
[[unknown_forces]]
name = "wind"
position_m = 9
[[virtual_sensors]]
name = "v2"
quantity = "displacement"
position_m = 6
)";
}

std::string asked_of_storeys() {
  std::string text;
  for (const char* storey : {"0", "3", "6"})
    text += std::string("[[parameters]]\nquantity = \"storey_stiffness\"\nname = \"k") + storey +
            "\"\nfrom_m = " + storey + "\nto_m = " + std::to_string(std::stoi(storey) + 3) +
            "\nform = \"logarithmic\"\nrelative_deviation = 0.3\n";
  return text;
}

TEST(Sensing, FindsStoreysFromGuessesAFifthOff) {
  // Oracle: the stiffnesses simulated, within 4 deviations (the force is smoother than its process, so that
  // these are a little small), and to a thousandth. With the noise stated the guess is some 100 deviations of
  // every reading off; damped modes have to follow the stiffnesses from the guess's shapes.
  const std::string noise = "noise_m_per_s2 = 0.02";
  const Experiment truth = experiment_of(building("[2.0e6, 1.6e6, 1.2e6]", noise));
  const Experiment guess = experiment_of(building("[1.6e6, 1.6e6, 1.6e6]", noise) + asked_of_storeys());
  const SensingRecord record = simulated_sensing(truth, {}, {}, unwatched);
  const SensingStudy study =
      study_sensing(guess, record, sensing_reduction(guess, record.record.interval()), {}, unwatched);
  ASSERT_TRUE(study.converged) << study.failure;
  EXPECT_FALSE(study.contradicted());
  const std::vector<double> k{2.0e6, 1.6e6, 1.2e6};
  for (std::size_t j = 0; j < k.size(); ++j) {
    const SensedConstant& one = study.constants[j];
    EXPECT_NEAR(one.value, k[j], 4.0 * (one.upper_95 - one.lower_95) / (2.0 * 1.96)) << one.name;
    EXPECT_NEAR(one.value, k[j], 1e-3 * k[j]) << one.name;
  }
}

TEST(Sensing, SeesTheColourOfTheNoiseOfAnySensor) {
  // Oracle: means of four successive normal numbers have a correlation of 3/4 from sample to sample. They are
  // added to the last sensor alone, 4 deviations of its own noise.
  const Experiment experiment = experiment_of(slower(mast));
  SensingRecord record = simulated_sensing(experiment, {}, {}, unwatched);
  const Choice reduction = sensing_reduction(experiment, record.record.interval());
  EXPECT_FALSE(study_sensing(experiment, record, reduction, {}, unwatched).correlated());
  filters::RandomStream random(7, 0);
  const Index last = record.measured - 1;
  const Eigen::VectorXd white = random.normal(record.record.size() + 3, 1);
  for (Index k = 0; k < record.record.size(); ++k)
    record.record.samples(last, k) += 0.2 * 0.5 * white.segment(k, 4).sum();
  EXPECT_TRUE(study_sensing(experiment, record, reduction, {}, unwatched).correlated());
}

TEST(Sensing, FindsTheNoiseOfSensorsThatReadMotionsOfSeveralSizes) {
  // Oracle: 0.02 m/s2, that of all three accelerometers, to 6 %: the force simulated is no process of
  // Matern, and makes more of it than the interval of 2.7 %.
  const std::string noise = "noise_m_per_s2 = 0.02";
  for (const char* seed : {"seed = 3", "seed = 5", "seed = 8"}) {
    std::string text = building("[2.0e6, 1.6e6, 1.2e6]", noise);
    text.replace(text.find("seed = 3"), 8, seed);
    const Experiment experiment = experiment_of(text);
    SensingRecord record = simulated_sensing(experiment, {}, {}, unwatched);
    for (Channel& one : record.record.channels) one.noise = 0.0;
    const SensingStudy study = study_sensing(
        experiment, record, sensing_reduction(experiment, record.record.interval()), {}, unwatched);
    ASSERT_TRUE(study.converged) << study.failure;
    bool found = false;
    for (const SensedConstant& one : study.constants) {
      if (one.name != "noise_acceleration") continue;
      found = true;
      EXPECT_NEAR(one.value, 0.02, 0.06 * 0.02) << seed;
    }
    EXPECT_TRUE(found);
  }
}

}  // namespace
}  // namespace beamid::sensing_test
