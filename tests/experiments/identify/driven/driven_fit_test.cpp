// A shear building on a base that has moved for ever. Oracle: its exact response (shaken_building.hpp), and a
// change of its storeys that a linear model lacks.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/first_guess.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "tests/experiments/shaken_building.hpp"

namespace beamid::experiments::driven_fit_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

const Vector3d stiffness = test::ShakenBuilding::stiffness(), ratio = test::ShakenBuilding::ratio();

Record shaken(Index samples, double noise, double softening) {
  return test::ShakenBuilding{noise, softening}.record(samples);
}

const Progress silent = [](const std::string&) {};

Experiment asked(double guess) {
  std::string text = fmt::format(
      "[chain]\nmasses_kg = [1, 1, 1]\nstiffnesses_n_per_m = [{0}, {0}, {0}]\nheights_m = [3, 3, "
      "3]\n[damping]\nlaw = "
      "\"modal\"\nratio = 0.02\n[model]\nname = \"beam\"\n[reduction]\nmethod = \"none\"\n",
      guess);
  for (int storey = 0; storey < 3; ++storey)
    text += fmt::format("[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = {}\nto_m = {}\n",
                        3 * storey, 3 * storey + 3);
  for (int mode = 1; mode <= 3; ++mode)
    text += fmt::format("[[parameters]]\nquantity = \"damping_ratio\"\nmode = {}\n", mode);
  return read_experiment(TomlTable::parse(text, "building.toml"));
}

struct Started {
  JointModel model;
  filters::Measurements record;
  filters::Gaussian prior;
};

Started started(const Record& record, double guess) {
  const Experiment experiment = asked(guess);
  const ModelSetting setting = model_setting(experiment, record, experiment.reduction);
  Started one{
      std::move(*model_registry().make("beam", experiment.model.options, setting)), measurements(record), {}};
  const FirstGuess own = own_guess(one.model, setting.observations, one.record.outputs);
  one.prior = {own.mean(one.model.unknown_places), own.unknowns, {}};
  return one;
}

class FromGuess : public testing::TestWithParam<double> {};

TEST_P(FromGuess, FindsTheExactBuilding) {
  const Started one = started(shaken(4000, 0.0, 0.0), GetParam());
  auto problem = driven_problem(one.model, one.record, one.prior);
  ASSERT_TRUE(problem);
  const auto fit = fit_driven(*problem);
  ASSERT_TRUE(fit);
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(std::exp(fit->theta[j]) / stiffness[j], 1.0, 1e-3) << "storey " << j + 1;
    EXPECT_NEAR(std::exp(fit->theta[3 + j]) / ratio[j], 1.0, 0.05) << "mode " << j + 1;
  }
  EXPECT_LT(fit->left_share, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Stiffness, FromGuess, testing::Values(1000.0, 1500.0, 3000.0, 6000.0));

TEST(DrivenFit, NeedsAMeasuredInputAndEverySample) {
  Record record = shaken(1000, 0.01, 0.0);
  record.samples(2, 500) = std::nan("");
  const Started gap = started(record, 3000.0);
  EXPECT_FALSE(driven_problem(gap.model, gap.record, gap.prior));
}

TEST(SectionScatter, IsThatOfNoiseWhereTheModelIsExact) {
  const Started one = started(shaken(12000, 0.3, 0.0), 3000.0);
  auto problem = driven_problem(one.model, one.record, one.prior);
  const auto fit = fit_driven(*problem);
  const auto scatter = section_scatter(one.model, one.record, one.prior, fit->theta, 3.7);
  ASSERT_TRUE(scatter);
  EXPECT_GE(scatter->sections, 6);
  const MatrixXd formal = fit->covariance(problem->prior);
  for (Index j = 0; j < 3; ++j) {
    const double factor = std::sqrt(scatter->covariance(j, j) / formal(j, j));
    EXPECT_GT(factor, 0.5);
    EXPECT_LT(factor, 2.5);
  }
}

TEST(SectionScatter, HoldsStiffnessThatChangesOverTheRecord) {
  constexpr double softening = 0.04;
  const Started one = started(shaken(12000, 0.05, softening), 3000.0);
  auto problem = driven_problem(one.model, one.record, one.prior);
  const auto fit = fit_driven(*problem);
  const auto scatter = section_scatter(one.model, one.record, one.prior, fit->theta, 3.7);
  ASSERT_TRUE(scatter);
  const MatrixXd formal = fit->covariance(problem->prior);
  for (Index j = 0; j < 3; ++j) {
    const double half = 1.96 * section_factor(*scatter, j, std::sqrt(formal(j, j))) * std::sqrt(formal(j, j));
    EXPECT_GT(section_factor(*scatter, j, std::sqrt(formal(j, j))), 2.0);
    EXPECT_GT(fit->theta[j] + half, std::log(stiffness[j] * (1.0 - softening)));
    EXPECT_LT(fit->theta[j] - half, std::log(stiffness[j]));
  }
}

TEST(SectionScatter, IsAbsentOfShortRecords) {
  const Started one = started(shaken(2000, 0.05, 0.0), 3000.0);
  EXPECT_FALSE(section_scatter(one.model, one.record, one.prior, one.prior.mean, 3.7));
}

// 1 % of stiffness between the halves of a record leaves motion that no building makes, and an answer all the
// same.
TEST(DrivenRecord, IsAnsweredApproximatelyWhereTheModelLacksSomething) {
  const Comparison found =
      identify_with_model(asked(1300.0), measured_record("building", shaken(12000, 0.05, 0.01)), {}, silent);
  const ComparedRun& run = found.runs.front();
  EXPECT_EQ(run.status, ComparedRun::Status::approximate) << run.reason;
  EXPECT_THAT(run.objections.front().text, testing::HasSubstr("the rest is not noise"));
  for (std::size_t j = 0; j < 3; ++j) {
    const Estimate& e = run.parameters[j].estimate;
    EXPECT_GT(e.value, 0.94 * stiffness[static_cast<Index>(j)]);
    EXPECT_LT(e.value, 1.02 * stiffness[static_cast<Index>(j)]);
  }
}

}  // namespace
}  // namespace beamid::experiments::driven_fit_test
