// What a wrong description does to a free decay, and what a reduction does to the parameters. Oracle: the
// beam that was simulated.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/compare/report.hpp"

namespace beamid::experiments::wrong_descriptions_test {
namespace {

using testing::HasSubstr, testing::StartsWith;

const Progress silent = [](const std::string&) {};

Experiment cantilever(double length_m, const std::vector<std::string>& reductions, double noise = 0.05,
                      const std::string& more = "") {
  Experiment e = read_experiment(TomlTable::parse(
      "[beam]\nlength_m = " + std::to_string(length_m) +
          "\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = 3.055\nelements = 20\n"
          "tip_mass_kg = 0.36\n[damping]\nlaw = \"modal\"\nratio = 0.004\n[simulation]\nduration_s = 15\n"
          "sampling_rate_hz = 200\nseed = 5\nmodes = 2\n[[sensors]]\nname = \"tip\"\nnoise_m_per_s2 = " +
          std::to_string(noise) +
          "\n[[sensors]]\nname = \"middle\"\nposition_m = 0.55\nnoise_m_per_s2 = 0.02\n[model]\nname = "
          "\"beam\"\n"
          "[[parameters]]\nquantity = \"bending_stiffness\"\nrelative_deviation = 0.5\n"
          "[[parameters]]\nquantity = \"damping_ratio\"\nguess = 0.003\n" +
          more,
      "test.toml"));
  for (const std::string& text : reductions) e.reductions.push_back(parse_reduction(text, "test"));
  if (!reductions.empty()) e.reduction = e.reductions[0];
  if (e.filters.empty()) e.filters = {e.filter};
  if (e.discretisations.empty()) e.discretisations = {e.discretisation};
  return e;
}

ComparedRun identified_as(double length_m) {
  const Experiment truth = cantilever(1.1, {"modal_truncation:modes=2"});
  ComparedRecord record = simulated_record(truth, {}, silent);
  for (Channel& channel : record.record.channels)  // places are described, too
    if (channel.name == "tip") channel.place = {}, channel.position = length_m;
  return identify_with_model(cantilever(length_m, {"modal_truncation:modes=2"}), record, {}, silent)
      .runs.at(0);
}

TEST(WrongDescription, OfAFreeDecayIsContradictedByItsOwnModes) {
  const ComparedRun right = identified_as(1.1);
  EXPECT_EQ(right.status, ComparedRun::Status::converged) << right.reason;
  ASSERT_TRUE(right.free_modes);
  EXPECT_FALSE(right.free_modes->exclude());
  EXPECT_LT(right.free_modes->chi_square, 4.0 * right.free_modes->freedom);
  const Estimate& stiffness = right.parameters.at(0).estimate;
  EXPECT_NEAR(stiffness.value, 228.96, 4.0 * stiffness.deviation);

  const ComparedRun wrong = identified_as(1.155);
  EXPECT_EQ(wrong.status, ComparedRun::Status::contradicted);
  ASSERT_FALSE(wrong.objections.empty());
  const auto found = std::ranges::find(wrong.objections, "free_modes", &Objection::name);
  ASSERT_NE(found, wrong.objections.end());
  EXPECT_THAT(found->text,
              StartsWith("CONTRADICTED: no parameters of this model make the modes of the record"));
  EXPECT_THAT(found->text, HasSubstr("as if all of it were one parameter's"));
  EXPECT_GT(wrong.parameters.at(0).estimate.deviation, 10.0 * stiffness.deviation);
}

// Four storeys whose highest mode is weak at the sensors; the second mass is 20 % heavier than
// described.
Experiment four_storeys(double second_kg) {
  std::string text = fmt::format(
      "[chain]\nmasses_kg = [1000, {}, 1000, 800]\nstiffnesses_n_per_m = [1.6e6, 1.5e6, 1.4e6, 1.3e6]\n"
      "heights_m = [3, 3, 3, 3]\n[damping]\nlaw = \"modal\"\nratio = 0.02\n[simulation]\nduration_s = 20\n"
      "sampling_rate_hz = 100\nseed = 4\n[model]\nname = \"beam\"\n[reduction]\nmethod = \"none\"\n",
      second_kg);
  for (int storey = 1; storey <= 4; ++storey)
    text += fmt::format("[[sensors]]\nposition_m = {}\nnoise_m_per_s2 = 0.03\n", 3 * storey);
  for (int storey = 0; storey < 4; ++storey)
    text += fmt::format("[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = {}\nto_m = {}\n",
                        3 * storey, 3 * storey + 3);
  text += "[[parameters]]\nquantity = \"damping_ratio\"\n";
  return read_experiment(TomlTable::parse(text, "chain.toml"));
}

TEST(WrongDescription, OfAMassWidensOrContradictsWhereAModeIsWeak) {
  const ComparedRecord record = simulated_record(four_storeys(1200.0), {}, silent);
  const std::vector<double> truth = {1.6e6, 1.5e6, 1.4e6, 1.3e6};
  const auto farthest = [&](const ComparedRun& run) {
    double most = 0.0;
    for (std::size_t j = 0; j < truth.size(); ++j)
      most = std::max(most, std::abs(run.parameters.at(j).estimate.value - truth[j]) /
                                run.parameters[j].estimate.deviation);
    return most;
  };
  const ComparedRun right = identify_with_model(four_storeys(1200.0), record, {}, silent).runs.at(0);
  EXPECT_EQ(right.status, ComparedRun::Status::converged) << right.reason;
  EXPECT_LT(farthest(right), 4.0);
  const ComparedRun wrong = identify_with_model(four_storeys(1000.0), record, {}, silent).runs.at(0);
  ASSERT_TRUE(wrong.free_modes);
  EXPECT_TRUE(wrong.free_modes->exclude());
  if (wrong.status == ComparedRun::Status::converged) {
    EXPECT_LT(farthest(wrong), 4.0);
  }
}

// Of a static shape, and of the lowest of few Lanczos vectors: the estimate less the truth, at a noise that
// is small.
TEST(ReductionBias, IsWhatTheEstimatesAreOff) {
  const Experiment e =
      cantilever(1.1, {"rayleigh", "krylov:moments=2", "modal_truncation:modes=2", "none"}, 0.001);
  const Comparison found = compare(e, simulated_record(e, {}, silent), {}, silent);
  for (const ComparedRun& run : found.runs) {
    if (!run.has_estimate()) continue;
    const Eigen::VectorXd bias = reduction_bias({e, found.compared, found.analysis}, run);
    const ComparedParameter& stiffness = run.parameters.at(0);
    const double error = stiffness.estimate.value / 228.96 - 1.0, predicted = bias.size() > 0 ? bias[0] : 0.0;
    EXPECT_NEAR(predicted, error, 0.1 * std::abs(error) + 4.0 * stiffness.estimate.deviation / 228.96)
        << run.reduction;
    EXPECT_TRUE(run.reduction != "rayleigh" || predicted < -0.01) << predicted;
  }
  std::ostringstream text;
  print(text, report(e, found));
  EXPECT_THAT(text.str(), HasSubstr("Least expected error"));
}

}  // namespace
}  // namespace beamid::experiments::wrong_descriptions_test
