// Structures updated by modes. Oracles: the published buildings (SCIENCE.md, section 9), the values that
// modes were computed from, the nominal share of 95 % intervals.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/identify/twins/twins.hpp"
#include "experiments/identify/update/update_study.hpp"
#include "filters/random.hpp"
#include "tests/experiments/identify/update/update_cases.hpp"

namespace beamid::experiments::updating_test {
namespace {

using Eigen::Index, Eigen::VectorXd, testing::HasSubstr;

const VectorXd second_set = lbf_per_in * VectorXd{{7.18, 8.08, 9.03, 14.69}};

UpdateSettings few_starts(int starts = 40, ModelTrust trust = {}) {
  return {trust, starts};
}

// Good and Turing: each place seen once speaks for one not seen.
TEST(Updating, OfFewStartsThatAgreeOnNothingSaysLittle) {
  Updating updating;
  updating.sets.resize(2);
  updating.sets[0].starts = 1, updating.sets[1].starts = 1;
  EXPECT_TRUE(starts_say_little(updating));
  updating.sets[0].starts = 9;
  EXPECT_FALSE(starts_say_little(updating));
}

TEST(Updating, NamesAllSixBuildingsOfFourFrequencies) {
  const UpdateStudy study =
      study_update(four_storeys(), frequencies(four_frequencies), few_starts(40, {0.0005, 0.03}));
  EXPECT_TRUE(study.complete());
  EXPECT_EQ(study.updating.as_well(), 6u);
  EXPECT_NEAR(study.updating.best().fit.chi_square(), 0.0, 1e-12);
  EXPECT_TRUE(study.updating.open.empty());
}

// MAC .999 .994 .997 .995 of the measured shapes chose the second set; here shapes of that set with
// components 4 % off.
TEST(Updating, ChoosesTheSecondBuildingByItsShapes) {
  ModalData data = predicted_data(four_storeys(), second_set, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    data.modes[i].frequency_hz = four_frequencies[i];
    data.modes[i].shape += 0.04 * filters::RandomStream(5, i).normal(4, 1);
    data.modes[i].shape_deviation = 0.04;
  }
  const UpdateStudy study = study_update(four_storeys(), data, few_starts(40, {0.002, 0.0}));
  EXPECT_EQ(study.updating.as_well(), 1u);
  EXPECT_TRUE(study.updating.explains());
  for (Index j = 0; j < 4; ++j) {
    const UpdatedParameter& one = study.updating.parameters[static_cast<std::size_t>(j)];
    EXPECT_LT(std::abs(one.value - second_set[j]), 3 * one.deviation);
  }
}

// Two frequencies for four storeys: two combinations stay open, and no interval is claimed.
TEST(Updating, ClaimsNothingThatTwoFrequenciesDoNotDetermine) {
  const UpdateStudy study = study_update(four_storeys(), frequencies({0.8829, 2.7477}), few_starts());
  EXPECT_EQ(study.updating.open.size(), 2u);
  for (const UpdatedParameter& one : study.updating.parameters) EXPECT_FALSE(one.determined);
  EXPECT_FALSE(study.complete());
}

// A prior is a measurement: with one on each storey everything is determined.
TEST(Updating, CountsStatedDeviationsAsMeasurements) {
  std::string text = "[chain]\nmasses_kg = [1000, 1000]\nstiffnesses_n_per_m = [1e6, 1e6]\n";
  for (int storey = 0; storey < 2; ++storey)
    text += "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = " + std::to_string(storey) +
            "\nto_m = " + std::to_string(storey + 1) + "\nrelative_deviation = 0.1\n";
  const UpdateStudy study = study_update(experiment_of(text), frequencies({3.0}), few_starts());
  EXPECT_TRUE(study.updating.open.empty());
  EXPECT_LT(study.updating.parameters[1].deviation, 0.1e6);
}

TEST(Updating, HoldsAParameterOnItsBoundAndSaysSo) {
  const char* text = R"toml([chain]
masses_kg = [1000, 1000]
stiffnesses_n_per_m = [1e6, 1e6]
[[parameters]]
quantity = "storey_stiffness"
from_m = 0
to_m = 1
lower_n_per_m = 0.8e6
upper_n_per_m = 1.1e6
[[parameters]]
quantity = "storey_stiffness"
from_m = 1
to_m = 2
)toml";
  const Experiment experiment = experiment_of(text);
  ModalData data = predicted_data(experiment_of(fmt::format("{}[[sensors]]\nposition_m = 2\n", text)),
                                  VectorXd{{1e6, 1e6}}, 2);
  for (MeasuredMode& mode : data.modes) mode.frequency_hz *= 1.3, mode.shape.resize(0);
  const UpdateStudy study = study_update(experiment, data, few_starts());
  EXPECT_TRUE(study.updating.parameters[0].on_bound);
  EXPECT_FALSE(study.updating.explains());
}

// Frequencies and shapes of a damaged three-storey building with noise as stated: 95 % intervals hold the
// truth in 95 % of 200 seeded cases, within three standard deviations of a binomial (1.5 % each).
TEST(Updating, HasIntervalsThatHoldTheTruthAsOftenAsTheySay) {
  const Experiment experiment = three_storeys();
  const VectorXd truth{{52536, 57625, 66086}};
  const ModalData exact = predicted_data(experiment, truth, 3);
  int held = 0;
  constexpr int cases = 200;
  for (std::uint64_t seed = 0; seed < cases; ++seed) {
    const ModalData data = with_errors(exact, 0.01, 11, seed);
    const UpdateStudy study = study_update(experiment, data, few_starts(4, {0.0, 0.0}));
    for (Index j = 0; j < 3; ++j) {
      const UpdatedParameter& one = study.updating.parameters[static_cast<std::size_t>(j)];
      held += one.lower_95 < truth[j] && truth[j] < one.upper_95 ? 1 : 0;
    }
  }
  EXPECT_NEAR(held / (3.0 * cases), 0.95, 0.03);
}

TEST(Updating, WarnsOfFrequenciesInRadiansPerSecond) {
  std::vector<double> wrong = three_frequencies;
  for (double& f : wrong) f *= 6.283185307;
  const UpdateStudy study = study_update(three_storeys(), frequencies(wrong), few_starts());
  ASSERT_FALSE(study.objections.empty());
  EXPECT_THAT(study.objections[0].text, HasSubstr("rad/s"));
}

TEST(Updating, WarnsOfAModeThatIsMissingInBetween) {
  const UpdateStudy study = study_update(four_storeys(), frequencies({0.885, 4.02, 4.76}), few_starts());
  std::string all;
  for (const std::string& warning : texts(study.objections)) all += warning;
  EXPECT_THAT(all, HasSubstr("Without mode 2"));
}

TEST(Updating, WarnsOfASensorMountedTheOtherWay) {
  ModalData data = predicted_data(four_storeys(), second_set, 4);
  for (MeasuredMode& mode : data.modes) mode.shape[2] = -mode.shape[2];
  const UpdateStudy study = study_update(four_storeys(), data, few_starts());
  std::string all;
  for (const std::string& warning : texts(study.objections)) all += warning;
  EXPECT_THAT(all, HasSubstr("sensor 3"));
  EXPECT_FALSE(study.updating.explains());
}

// Modes in any order and with any sign are the same modes.
TEST(Updating, PairsNumberedModesAsTheFileSays) {
  ModalData data = frequencies({0.8829, 4.2998});
  data.modes[0].number = 1;
  data.modes[1].number = 3;
  const UpdateStudy study = study_update(four_storeys(), data, few_starts());
  EXPECT_EQ(study.updating.best().fit.value.pairs[1], 2);
  EXPECT_NEAR(study.updating.best().fit.chi_square(), 0.0, 1e-9);
}

// Oracle: the measurement is made on each of the six buildings; what it is said to be is what it is.
TEST(DecidingMeasurements, SeparateTheSixBuildings) {
  const UpdateStudy study =
      study_update(four_storeys(), frequencies(four_frequencies), few_starts(40, {0.0005, 0.03}));
  ASSERT_FALSE(study.deciding.empty());
  EXPECT_GT(study.deciding.front().separation, 1.0);
  EXPECT_EQ(study.deciding.front().predicted.size(), 6u);
}

}  // namespace
}  // namespace beamid::experiments::updating_test
