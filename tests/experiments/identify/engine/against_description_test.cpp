// Estimates beside what was described beforehand. Oracle: an oscillator under a known force, exactly, whose
// force is recorded with a wrong factor: mass, stiffness and damping are then wrong by that factor, whatever
// else is.
#include "experiments/identify/verdict/run_verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/config/read_experiment.hpp"
#include "tests/experiments/forced_oscillator.hpp"

namespace beamid::experiments::against_description_test {
namespace {

using testing::AllOf, testing::Contains, testing::HasSubstr, testing::IsEmpty, testing::Not;

constexpr double mass = 100.0, frequency = 2.0;  // [kg], [Hz]

// @param gain of the recorded force over that which acted
ComparedRun identified(double gain, std::uint64_t seed) {
  const Oscillator truth = Oscillator::from_frequency(mass, 2.0 * std::numbers::pi * frequency, 0.01);
  const Experiment e = read_experiment(TomlTable::parse(
      "[chain]\nmasses_kg = [100]\nstiffnesses_n_per_m = [15791.4]\n[model]\nname = \"sdof\"\n[filter]\n"
      "discretisation = \"exponential\"\n",
      "test.toml"));
  ComparedRecord compared;
  compared.name = "driven";
  compared.record = test::driven_throughout(truth, 40, 50, 0.005, seed);
  compared.record.input_path = InputPath::linear;
  compared.record.samples.row(1) *= gain;
  return identify_with_model(e, compared, {}, [](const std::string&) {}).runs.at(0);
}

struct Unit {
  double gain;
  const char* name;
};

TEST(AgainstDescription, AForceInAnotherUnitIsNamed) {
  for (const auto& [gain, name] : {Unit{9.80665, "9.80665, a force in N taken for kgf"},
                                   Unit{1.0 / 9.80665, "a force in kgf taken for N"},
                                   Unit{4.44822, "a force in N taken for pounds-force"}}) {
    const ComparedRun run = identified(gain, 1);
    EXPECT_EQ(run.status, ComparedRun::Status::contradicted) << gain;
    EXPECT_NEAR(run.parameters.at(2).estimate.value / (gain * mass), 1.0, 0.01);
    EXPECT_THAT(texts(run.objections), testing::Contains(HasSubstr(name)));
  }
}

// The filter may lose such a record, three orders from the prior, or one whose sign is turned.
TEST(AgainstDescription, AForceThatMakesNoMotionIsNamedAsTheCause) {
  for (const auto& [gain, name] : {Unit{1000.0, "a force in N taken for kN"},
                                   Unit{0.001, "a force in kN taken for N"}, Unit{-1.0, "against it"}}) {
    const ComparedRun run = identified(gain, 1);
    EXPECT_NE(run.status, ComparedRun::Status::converged) << gain;
    EXPECT_THAT(texts(run.objections), Contains(HasSubstr(name))) << gain;
  }
}

// A fifth is two of the deviations of a mass known to 10 %: no contradiction, but no coincidence either, as
// mass and stiffness are off by the same fifth.
TEST(AgainstDescription, ASmallGainIsSaidWithoutAContradiction) {
  const ComparedRun run = identified(1.2, 1);
  EXPECT_EQ(run.status, ComparedRun::Status::converged);
  EXPECT_THAT(texts(run.objections), Contains(HasSubstr("come out 1.2 times as large as described")));
}

TEST(AgainstDescription, AHealthyRecordIsSilent) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
    const ComparedRun run = identified(1.0, seed);
    EXPECT_EQ(run.status, ComparedRun::Status::converged);
    EXPECT_THAT(texts(run.objections), IsEmpty()) << seed;
  }
}

ComparedParameter parameter(const char* name, const char* unit, double value, double prior,
                            double deviation) {
  ComparedParameter p;
  p.estimate = {name, unit, value, 1e-3 * value, 0.998 * value, 1.002 * value, prior, deviation, false};
  return p;
}

TEST(AgainstDescription, OneParameterFarFromItsEstimateIsNamedAlone) {
  const auto found =
      against_description({parameter("mass", "kg", 100, 100, 10), parameter("stiffness", "N/m", 250, 100, 30),
                           parameter("damping", "N s/m", 50, 1, 1)},  // no estimate
                          true);
  EXPECT_EQ(found.scale, "");
  ASSERT_EQ(found.differences.size(), 1u);
  EXPECT_THAT(found.differences[0], AllOf(HasSubstr("stiffness comes out as 250 N/m, 5 standard deviations"),
                                          HasSubstr("(2.5 times)")));
}

TEST(AgainstDescription, WithoutAMeasuredForceThereIsNoScale) {
  const auto found = against_description(
      {parameter("tip_mass", "kg", 980, 100, 10), parameter("bending_stiffness", "N m2", 980, 100, 30)},
      false);
  EXPECT_EQ(found.scale, "");
  EXPECT_EQ(found.differences.size(), 2u);
}

}  // namespace
}  // namespace beamid::experiments::against_description_test
