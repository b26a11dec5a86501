// A shear building on a base that has moved for ever. Oracle: its exact response (shaken_building.hpp), and a
// change of its storeys that a linear model lacks.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <complex>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/first_guess.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/scheme.hpp"
#include "tests/experiments/identify/ground_motion.hpp"
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

// What the sections' scores scatter in all directions of the unknowns together, S / ((S - 1) q) sum of s_i^T
// I^-1 s_i of scores without their mean, is worked out here from the sections themselves.
double scatter_in_all_directions(const DrivenFit& sections, const MatrixXd& information) {
  const MatrixXd scores = 2.0 * sections.scores;
  const MatrixXd off = scores.colwise() - scores.rowwise().mean().eval();
  const auto count = static_cast<double>(off.cols()), unknowns = static_cast<double>(off.rows());
  return count / ((count - 1.0) * unknowns) * (off.transpose() * information.inverse() * off).trace();
}

// A storey that softens half way. By chance the few sections scatter little in one unknown: its interval is
// that of the scatter in all directions at least, by Student's t of the sections.
TEST(SectionScatter, OfNoUnknownIsBelowThatOfAllDirections) {
  double narrowest = 10.0;
  for (const std::uint64_t seed : {5, 6, 7, 8}) {
    const Started one = started(test::ShakenBuilding{0.05, 0.04, seed}.record(4800), 3000.0);
    auto problem = driven_problem(one.model, one.record, one.prior);
    const DrivenFit fit = fit_driven(*problem).value();
    const auto scatter = section_scatter(one.model, one.record, one.prior, fit.theta, 3.7);
    ASSERT_TRUE(scatter);
    const auto parts = in_sections(*problem, one.record, scatter->sections);
    weigh_by_residual(*problem, fit.theta);
    DrivenProblem weighed = *parts;
    weighed.weights = problem->weights;
    const DrivenFit sections = evaluate_driven(weighed, fit.theta);
    const MatrixXd information =
        2.0 * sections.information + one.prior.covariance.llt().solve(MatrixXd::Identity(6, 6));
    const double least = std::sqrt(scatter_in_all_directions(sections, information)) *
                         student_factor(static_cast<double>(scatter->sections - 1));
    for (Index j = 0; j < 6; ++j)
      narrowest =
          std::min(narrowest, section_factor(*scatter, j, std::sqrt(information.inverse()(j, j))) / least);
  }
  EXPECT_GT(narrowest, 0.999);
}

// Oracle: the law the sections are drawn from, eta = 1 + b log2 A + e with e of the sections' own deviations
// and 0.02 of the structure's. Of 1,000 draws without a slope 1 % may be called a trend, of the intervals 95
// % hold b.
SectionScatter drawn_sections(double slope, std::mt19937& seed) {
  constexpr Index sections = 12;
  std::normal_distribution<double> normal;
  SectionScatter drawn;
  drawn.sections = sections;
  drawn.size.resize(sections);
  drawn.estimates.resize(1, sections);
  drawn.own_deviation.resize(1, sections);
  for (Index i = 0; i < sections; ++i) {
    drawn.size[i] = std::exp2(-4.0 + 0.4 * static_cast<double>(i));
    drawn.own_deviation(0, i) = 0.005 / drawn.size[i];
    drawn.estimates(0, i) =
        1.0 + slope * std::log2(drawn.size[i]) + std::hypot(0.02, drawn.own_deviation(0, i)) * normal(seed);
  }
  return drawn;
}

TEST(TrendWithSize, HasItsSizeAndItsCoverage) {
  constexpr int draws = 1000;
  constexpr double slope = -0.05;
  std::mt19937 seed(7);
  int called = 0, held = 0, found = 0;
  for (int k = 0; k < draws; ++k) {
    called += trend_with_size(drawn_sections(0.0, seed), 0).exists(1);
    const SizeTrend trend = trend_with_size(drawn_sections(slope, seed), 0);
    held += std::abs(trend.slope - slope) < 2.228 * trend.deviation;  // Student's t of 10 degrees of freedom
    found += trend.exists(1);
  }
  EXPECT_LE(called, 25);
  EXPECT_GE(held, 925);
  EXPECT_GE(found, 900);
}

TEST(TrendWithSize, IsAbsentOfSectionsOfOneSize) {
  std::mt19937 seed(8);
  SectionScatter drawn = drawn_sections(0.0, seed);
  drawn.size.setOnes();
  EXPECT_FALSE(trend_with_size(drawn, 0).exists(1));
}

TEST(SectionScatter, IsAbsentOfShortRecords) {
  const Started one = started(shaken(900, 0.05, 0.0), 3000.0);
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

// Forward Euler by another name: the order of its error is one all the same.
class HeldSlope final : public filters::Scheme {
 public:
  void step(const filters::ContinuousModel& model, const VectorXd& state, const VectorXd& input, double dt,
            VectorXd& next, MatrixXd* tangent) override {
    euler_->step(model, state, input, dt, next, tangent);
  }
  Amplification amplification(std::complex<double> z) const override { return euler_->amplification(z); }

 private:
  std::unique_ptr<filters::Scheme> euler_ = filters::scheme_registry().make("forward_euler", {});
};

// Short sections determine nothing beside the bias of a scheme of first order. Oracle: 81 periods of a storey
// that softens, which have short sections by an exact scheme.
TEST(DrivenRecord, HasNoShortSectionsByASchemeOfFirstOrder) {
  filters::scheme_registry().add(
      {"held_slope", "a test's", "", {}, {}, [](const auto&) { return std::make_unique<HeldSlope>(); }});
  const auto sections_by = [](const std::string& scheme) {
    Experiment experiment = asked(2500.0);
    experiment.discretisation = scheme;
    const ComparedRun run =
        identify_with_model(experiment, measured_record("building", shaken(2200, 0.05, 0.02)), {}, silent)
            .runs.front();
    EXPECT_TRUE(run.has_estimate()) << scheme << ": " << run.reason;
    return run.sections.has_value();
  };
  EXPECT_TRUE(sections_by("exponential"));
  EXPECT_FALSE(sections_by("held_slope"));
}

// A gain of 1.5 % is a hundred of the filter's own deviations, by which a pass still moves: the cause is
// named, and the stiffnesses are those of the building.
TEST(DrivenRecord, OfAWrongGainIsNotCalledUnsettled) {
  Record record = shaken(6000, 0.02, 0.0);
  record.samples.row(2) *= 1.015;
  const ComparedRun run =
      identify_with_model(asked(1700.0), measured_record("building", record), {}, silent).runs.front();
  EXPECT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  for (const Objection& one : run.objections) EXPECT_NE(one.name, "not_settled") << one.text;
  EXPECT_THAT(run.objections.front().text, testing::HasSubstr("gain of floor_2 1.015"));
  for (std::size_t j = 0; j < 3; ++j)
    EXPECT_NEAR(run.parameters[j].estimate.value / stiffness[static_cast<Index>(j)], 1.0, 0.01);
}

// All 20 coordinates of a mesh: modes that die out within a sample have no amplitude in the record.
TEST(UnreducedMesh, OnAMovingBaseIsFound) {
  const auto ground = std::filesystem::path(testing::TempDir()) / "mesh_on_ground.csv";
  beamid::test::write_ground_motion(ground, 2200);
  const auto beam = [&](double youngs_modulus) {
    Experiment e = read_experiment(TomlTable::parse(
        fmt::format(
            "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = {}\n"
            "density_kg_per_m3 = 7850\nelements = 10\ntip_mass_kg = 0.36\n[damping]\nratio = 0.01\n"
            "[excitation]\nkind = \"base\"\nfile = \"{}\"\n[simulation]\nduration_s = 20\n"
            "sampling_rate_hz = 200\n[[sensors]]\nnoise_m_per_s2 = 0.05\n[[sensors]]\nposition_m = 0.6\n"
            "noise_m_per_s2 = 0.05\n[model]\nname = \"beam\"\n[reduction]\nmethod = \"none\"\n"
            "[[parameters]]\nquantity = \"bending_stiffness\"\n[[parameters]]\nquantity = "
            "\"damping_ratio\"\n",
            youngs_modulus, ground.string()),
        "mesh.toml"));
    return e;
  };
  const ComparedRecord record = simulated_record(beam(2.1e11), {}, silent);
  const ComparedRun run = identify_with_model(beam(1.9e11), record, {}, silent).runs.at(0);
  EXPECT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  const Estimate &stiffness = run.parameters.at(0).estimate, &ratio = run.parameters.at(1).estimate;
  EXPECT_NEAR(stiffness.value, 2.1e11 * 0.06 * 0.006 * 0.006 * 0.006 / 12.0, 4.0 * stiffness.deviation);
  EXPECT_NEAR(ratio.value, 0.01, 4.0 * ratio.deviation);
}

}  // namespace
}  // namespace beamid::experiments::driven_fit_test
