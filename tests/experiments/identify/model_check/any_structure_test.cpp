// Frames, space frames, chains and systems of the tutorials whose description is wrong in one known thing.
// Oracle everywhere: the quantity that was changed, by how much, and the modes of the changed structure.
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/model_check/model_check.hpp"
#include "experiments/identify/model_check/shared_residual.hpp"
#include "experiments/studies/check/report.hpp"
#include "fem/modes.hpp"
#include "tests/experiments/identify/update/update_cases.hpp"

namespace beamid::experiments::any_structure_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd, testing::HasSubstr;
using Verdict = Explanation::Verdict;

Experiment tutorial(const std::string& file) {
  return read_experiment(std::filesystem::path(BEAMID_SOURCE_DIR) / "docs/tutorials" / file);
}

Experiment portal() {
  return tutorial("17_any_structure/frame.toml");
}

Experiment matrices() {
  return tutorial("17_any_structure/system.toml");
}

/// Coarse enough for many modes in a second.
Experiment tower() {
  Experiment experiment = tutorial("18_space_frame/tower.toml");
  experiment.elements = 1;
  return experiment;
}

std::vector<fem::Point> sensor_places(const Experiment& experiment) {
  std::vector<fem::Point> points;
  for (const Sensor& sensor : experiment.sensors)
    points.push_back({sensor.name, sensor.position.value_or(0.0), sensor.place});
  return points;
}

/// As described, with the modes of the structure changed so. @param shapes at the sensors as well
CheckedStructure changed(const Experiment& experiment, const std::string& name, double change, Index modes,
                         bool shapes = false) {
  CheckedStructure result{experiment.structure.kind(), experiment.structure, experiment.elements, {}, {}};
  fem::Structure truth = experiment.structure;
  for (const Candidate& candidate : candidates_of({truth}))
    if (candidate.name == name) truth = candidate.changed(experiment.structure, change);
  const fem::StructuralSystem system = fem::assemble(truth, experiment.elements, sensor_places(experiment));
  const fem::Modes found = fem::modes(system, modes);
  const VectorXd frequency = found.frequency_hz();
  const MatrixXd seen = system.outputs * found.shape;
  for (Index i = 0; i < modes; ++i) {
    result.modes.push_back({frequency[i], 1e-4 * frequency[i], 0.01, 1e-4});
    if (shapes) result.modes.back().shape = seen.col(i).cast<std::complex<double>>();
  }
  if (shapes)
    for (const Sensor& sensor : experiment.sensors)
      result.channels.push_back({Quantity::displacement, sensor.name, sensor.position, 0.0, sensor.place});
  return result;
}

const Candidate& cause_of(const ModelCheck& check, const Explanation& e) {
  return check.candidates[e.candidates[0]];
}

void expect_single_cause(const ModelCheck& check, const std::string& name, double change) {
  EXPECT_FALSE(check.right);
  const Explanation& best = check.single.front();
  ASSERT_EQ(cause_of(check, best).name, name) << testing::PrintToString(conclusions(check));
  EXPECT_EQ(best.verdict, Verdict::explains);
  EXPECT_NEAR(best.change[0], change, 2e-3 * std::abs(change));
  EXPECT_LT(best.lower_95(0), change);
  EXPECT_GT(best.upper_95(0), change);
  EXPECT_LT(best.chi_square, 1e-3);
  EXPECT_THAT(conclusions(check)[1], HasSubstr("One single change explains the difference: "));
}

TEST(ModelCheckOfAFrame, FindsTheWeakenedGroup) {
  const ModelCheck check =
      check_model({changed(portal(), "lower_girder", -0.25, 5)}, {.model_error = 0.001, .candidates = {}});
  expect_single_cause(check, "lower_girder", -0.25);
}

TEST(ModelCheckOfAFrame, FindsSupportsThatGive) {
  const ModelCheck check = check_model({changed(portal(), "support_compliance", 0.05, 5)},
                                       {.model_error = 0.0005, .candidates = {}});
  expect_single_cause(check, "support_compliance", 0.05);
}

TEST(ModelCheckOfASpaceFrame, FindsTheWrongBody) {
  const ModelCheck check = check_model({changed(tower(), "body_mass_c3", -0.18, 5, true)},
                                       {.model_error = 0.001, .candidates = {}});
  expect_single_cause(check, "body_mass_c3", -0.18);
}

TEST(ModelCheckOfASystem, FindsItsParameter) {
  const ModelCheck check =
      check_model({changed(matrices(), "k2", -0.15, 3)}, {.model_error = 0.002, .candidates = {}});
  expect_single_cause(check, "k2", -0.15);
}

TEST(ModelCheckOfAChain, FindsTheSoftStorey) {
  const ModelCheck check = check_model({changed(four_storeys(), "storey_stiffness_2", -0.2, 4, true)},
                                       {.model_error = 0.002, .candidates = {}});
  expect_single_cause(check, "storey_stiffness_2", -0.2);
}

// Nothing is changed: nothing may be blamed, of whatever structure, nor any pair.
TEST(ModelCheckOfAnyStructure, SaysThatARightOneIsRight) {
  for (const Experiment& experiment : {portal(), tower(), matrices(), four_storeys()}) {
    const ModelCheck check = check_model({changed(experiment, "", 0, 3, true)}, {});
    EXPECT_TRUE(check.right) << experiment.structure.kind();
    EXPECT_NEAR(check.chi_square, 0, 1e-9);
    EXPECT_THAT(conclusions(check)[0], HasSubstr("agrees"));
    for (const Explanation& one : check.single) {
      EXPECT_LE(one.lower_95(0), 1e-9) << cause_of(check, one).name;
      EXPECT_GE(one.upper_95(0), -1e-9) << cause_of(check, one).name;
    }
  }
}

// E of all members, or the clock, for frequencies: sqrt(1 + x) for one, 1 + x for the other.
TEST(ModelCheckOfAFrame, NamesBothOfTwoCausesThatExplainAlike) {
  const ModelCheck check = check_model({changed(portal(), "youngs_modulus", 0.05, 4, true)},
                                       {.model_error = 0.001, .candidates = {}});
  const std::string said = conclusions(check)[1];
  EXPECT_THAT(said, HasSubstr("explains the difference equally well"));
  EXPECT_THAT(said, HasSubstr("youngs modulus +5 %"));
  EXPECT_THAT(said, HasSubstr("record clock +2.47 %"));
  EXPECT_THAT(conclusions(check).back(), HasSubstr("youngs modulus, record clock"));
}

// Two groups are off: no change alone explains six modes, and this pair does.
TEST(ModelCheckOfAFrame, FindsAPairWhereNoChangeAloneExplains) {
  const Experiment experiment = portal();
  CheckedStructure frame = changed(experiment, "", 0, 6, true);
  Experiment truth = experiment;
  for (const Candidate& c : candidates_of({truth.structure})) {
    if (c.name == "columns") truth.structure = c.changed(truth.structure, -0.2);
    if (c.name == "upper_girder") truth.structure = c.changed(truth.structure, 0.25);
  }
  frame.modes = changed(truth, "", 0, 6, true).modes;
  const ModelCheck check = check_model(
      {frame},
      {.model_error = 0.0005, .candidates = {"youngs_modulus", "columns", "upper_girder", "member_mass"}});
  for (const Explanation& one : check.single) EXPECT_EQ(one.verdict, Verdict::leaves_much);
  ASSERT_FALSE(check.pairs.empty());
  const Explanation& best = check.pairs.front();
  EXPECT_EQ(check.candidates[best.candidates[0]].name, "columns");
  EXPECT_EQ(check.candidates[best.candidates[1]].name, "upper_girder");
  EXPECT_NEAR(best.change[0], -0.2, 1e-3);
  EXPECT_NEAR(best.change[1], 0.25, 1e-3);
}

// Oracle: central differences of frequencies, and of the shapes of the two sway modes made comparable by
// their first component. In the others the sensors hardly move.
TEST(CauseModel, HasTheDerivativesOfItsModes) {
  const Experiment experiment = portal();
  const std::vector<Candidate> all = candidates_of({experiment.structure});
  for (const Candidate& candidate : all) {
    const CauseModel model(experiment.structure, experiment.elements, sensor_places(experiment), {candidate},
                           4);
    const double x = 0.3 * candidate.plausible_upper, h = 1e-3 * candidate.scale();
    const auto at = [&](double place) { return model.at(VectorXd::Constant(1, place), false); };
    const PredictedModes here = model.at(VectorXd::Constant(1, x), true), more = at(x + h), less = at(x - h);
    const VectorXd slope = (more.frequency_hz - less.frequency_hz) / (2 * h);
    EXPECT_LT((here.frequency_slopes.col(0) - slope).norm(), 1e-5 * slope.norm()) << candidate.name;
    for (Index k = 0; k < 2; ++k) {
      const auto ratio = [k](const PredictedModes& m) { return m.shapes(1, k) / m.shapes(0, k); };
      const MatrixXd& change = here.shape_slopes[static_cast<std::size_t>(k)];
      const double known = (change(1, 0) - ratio(here) * change(0, 0)) / here.shapes(0, k);
      EXPECT_NEAR(known, (ratio(more) - ratio(less)) / (2 * h), 1e-4 * (1 + std::abs(ratio(here))))
          << candidate.name << " mode " << k + 1;
    }
  }
}

}  // namespace
}  // namespace beamid::experiments::any_structure_test
