// Beams whose description is wrong in one known thing. Oracle everywhere: the quantity that was changed, by
// how much, and the frequencies of the changed beam itself.
#include "experiments/identify/model_check/model_check.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "experiments/studies/check/report.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments::model_check_test {
namespace {

using testing::HasSubstr, testing::Not;
using Verdict = Explanation::Verdict;

constexpr double length = 0.4, stiffness = 95.0, mass_per_length = 1.2;

fem::Beam cantilever(double tip_mass) {
  fem::Beam beam;
  fem::Section section;
  section.bending_stiffness = stiffness, section.mass_per_length = mass_per_length;
  beam.segments = {{length, section}};
  beam.supports = {{0.0}};
  if (tip_mass > 0) beam.bodies = {{length, tip_mass}};
  return beam;
}

/// Described as `beam`, with the modes that the changed beam has.
CheckedStructure structure(const fem::Beam& beam, const std::string& name, double change, int modes) {
  CheckedStructure result{"beam", beam, 8, {}, {}};
  fem::Beam truth = beam;
  for (const Candidate& candidate : candidates_of({beam}))
    if (candidate.name == name) truth = candidate.changed(beam, change).beam();
  for (const double f : fem::modes(fem::assemble(truth, 8), modes).frequency_hz())
    result.modes.push_back({f, 1e-4 * f, 0.01, 1e-4});
  return result;
}

const Candidate& candidate_of(const ModelCheck& check, const Explanation& explanation, std::size_t i = 0) {
  return check.candidates[explanation.candidates[i]];
}

struct Wrong {
  const char* name;
  double change;
};

void PrintTo(const Wrong& tested, std::ostream* stream) {
  *stream << tested.name;
}

class WrongBeam : public testing::TestWithParam<Wrong> {};

// Four modes, each with a tenth of a per cent of model error: enough to tell all of these apart.
TEST_P(WrongBeam, IsFoundAndNamed) {
  const auto [name, change] = GetParam();
  const ModelCheck check =
      check_model({structure(cantilever(0.3), name, change, 4)}, {.model_error = 0.001, .candidates = {}});
  EXPECT_FALSE(check.right);
  const Explanation& best = check.single.front();
  ASSERT_EQ(candidate_of(check, best).name, name);
  EXPECT_EQ(best.verdict, Verdict::explains);
  EXPECT_NEAR(best.change[0], change, 1e-3 * std::abs(change));
  EXPECT_LT(best.chi_square, 1e-3);
  EXPECT_THAT(conclusions(check)[1], HasSubstr("explain"));
}

INSTANTIATE_TEST_SUITE_P(All, WrongBeam,
                         testing::Values(Wrong{"bending_stiffness", 0.08}, Wrong{"beam_mass", -0.04},
                                         Wrong{"tip_mass", 0.05}, Wrong{"tip_rotary_inertia", 4e-4},
                                         Wrong{"tip_offset", 0.01}, Wrong{"free_length", -0.012},
                                         Wrong{"root_rotational_compliance", 2e-4},
                                         Wrong{"root_translational_compliance", 3e-7}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(ModelCheck, SaysThatARightBeamIsRight) {
  const ModelCheck check = check_model({structure(cantilever(0.3), "", 0, 3)}, {});
  EXPECT_TRUE(check.right);
  EXPECT_NEAR(check.chi_square, 0, 1e-12);
  EXPECT_THAT(conclusions(check)[0], HasSubstr("agrees"));
  for (const Explanation& one : check.single) EXPECT_LE(one.lower_95(0), 0) << candidate_of(check, one).name;
}

// All frequencies of a bare uniform beam go as sqrt(E I / m) / L^2, whatever the mode.
TEST(ModelCheck, SaysWhichCandidatesAreNotSeparable) {
  const ModelCheck check = check_model({structure(cantilever(0), "bending_stiffness", 0.1, 4)},
                                       {0.005, {"bending_stiffness", "beam_mass", "free_length"}});
  EXPECT_THAT(testing::PrintToString(conclusions(check)),
              HasSubstr("Indistinguishable by these modes, within each group: bending stiffness, beam mass, "
                        "free length."));
  for (const Explanation& pair : check.pairs) EXPECT_EQ(pair.verdict, Verdict::undetermined);
}

// Oracle: the pair of changes that was made, which leaves nothing. One descent from "nothing changed" ends in
// another minimum of this pair.
TEST(ModelCheck, FindsTheBestOfSeveralMinimaOfAPair) {
  const fem::Beam beam = cantilever(1.4);
  fem::Beam truth = beam;
  for (const auto& [name, change] : {std::pair{"bending_stiffness", 0.3}, {"tip_offset", -0.135 * length}})
    for (const Candidate& candidate : candidates_of({truth}))
      if (candidate.name == name) {
        truth = candidate.changed(truth, change).beam();
        break;
      }
  CheckedStructure changed{"beam", beam, 8, {}, {}};
  for (const double f : fem::modes(fem::assemble(truth, 8), 4).frequency_hz())
    changed.modes.push_back({f, 1e-4 * f, 0.01, 1e-4});
  const ModelCheck check = check_model({changed}, {0.005, {"bending_stiffness", "tip_offset"}});
  ASSERT_EQ(check.pairs.size(), 1U);
  EXPECT_LT(check.pairs[0].chi_square, 1e-3);
}

// A stiffness moves the frequencies of all tip masses in one proportion, a forgotten mass the light ones
// more.
TEST(ModelCheck, TellsFromSeveralTipMassesWhatOneCannot) {
  const ModelCheckSettings settings{0.002, {"bending_stiffness", "tip_mass"}};
  std::vector<CheckedStructure> several;
  for (const double mass : {1.4, 0.7, 0.25})
    several.push_back(structure(cantilever(mass), "tip_mass", 0.04, 1));
  const ModelCheck one = check_model({several[0]}, settings), joint = check_model(several, settings);
  EXPECT_THAT(testing::PrintToString(conclusions(one)), HasSubstr("One frequency cannot distinguish"));
  EXPECT_EQ(candidate_of(joint, joint.single[0]).name, "tip_mass");
  EXPECT_NEAR(joint.single[0].change[0], 0.04, 1e-4);
  EXPECT_EQ(joint.single[1].verdict, Verdict::leaves_much);
  EXPECT_THAT(testing::PrintToString(conclusions(joint)),
              Not(testing::ContainsRegex("cannot (show|distinguish)")));
}

TEST(ModelCheck, HoldsAClampThatWouldHaveToBeStifferThanRigid) {
  const ModelCheck check = check_model({structure(cantilever(0.3), "bending_stiffness", 0.1, 2)},
                                       {0.001, {"root_rotational_compliance"}});
  EXPECT_EQ(check.single[0].change[0], 0);
  EXPECT_TRUE(check.single[0].at_limit[0]);
  EXPECT_EQ(check.single[0].verdict, Verdict::leaves_much);
}

TEST(ModelCheck, CallsAChangeBeyondReasonImplausible) {
  const ModelCheck check =
      check_model({structure(cantilever(0.3), "bending_stiffness", 0.4, 3)}, {0.002, {"bending_stiffness"}});
  EXPECT_NEAR(check.single[0].change[0], 0.4, 1e-3);
  EXPECT_EQ(check.single[0].verdict, Verdict::implausible);
  EXPECT_THAT(testing::PrintToString(conclusions(check)), HasSubstr("No plausible single change"));
}

// A mode 20 % below the first belongs to it; a mode in the middle between two belongs to neither.
TEST(ModelCheck, LeavesOutModesWithoutCounterpart) {
  CheckedStructure beam = structure(cantilever(0), "", 0, 2);
  const double between = std::sqrt(beam.modes[0].frequency_hz * beam.modes[1].frequency_hz);
  beam.modes.push_back({between, 1e-3, 0.01, 1e-4});
  const ModelCheck check = check_model({beam}, {});
  EXPECT_EQ(check.modes.size(), 2u);
  ASSERT_EQ(check.strays.size(), 1u);
  EXPECT_EQ(check.strays[0].second.frequency_hz, between);
  beam.modes = {beam.modes[2]};
  EXPECT_THROW(check_model({beam}, {}), std::invalid_argument);
}

// Oracle: the shapes of the beam itself, at two sensors.
TEST(ModelCheck, ComparesShapesWhereThereAreSeveralChannels) {
  CheckedStructure beam = structure(cantilever(0), "", 0, 2);
  beam.channels = {{Quantity::acceleration, "middle", 0.5 * length}, {Quantity::acceleration, "tip", length}};
  const auto system = fem::assemble(beam.structure, 8, {{"middle", 0.5 * length}, {"tip", length}});
  const Eigen::MatrixXd shapes = system.outputs * fem::modes(system, 2).shape;
  for (int m = 0; m < 2; ++m) beam.modes[m].shape = (3 * shapes.col(m)).cast<std::complex<double>>();
  const ModelCheck check = check_model({beam}, {});
  ASSERT_EQ(check.modes.size(), 2u);
  for (const CheckedMode& mode : check.modes) EXPECT_NEAR(mode.assurance, 1, 1e-9);
}

// A logger 2 % too fast: all frequencies by 2 %, as by E I (4 %), by the mass and by the length (1 %). A tip
// mass of this size would move the third mode by less than the first. Oracle: f ~ sqrt(E I / m) / L^2.
TEST(ModelCheck, NamesTheClockAmongWhatMovesAllFrequenciesAlike) {
  CheckedStructure beam = structure(cantilever(0), "", 0, 3);
  for (ObservedMode& mode : beam.modes) mode.frequency_hz *= 1.02;
  const ModelCheck check = check_model({beam}, {.model_error = 0.001, .candidates = {}});
  const std::vector<std::string> said = conclusions(check);
  for (const char* const cause :
       {"record clock +2 %", "bending stiffness +4.04 %", "beam mass -3.88 %", "free length -0.00394 m"})
    EXPECT_THAT(said[1], HasSubstr(cause));
  EXPECT_THAT(said.back(), HasSubstr("Indistinguishable by these modes"));
  EXPECT_THAT(said.back(), HasSubstr("bending stiffness, beam mass, free length"));
  EXPECT_THAT(said.back(), HasSubstr("record clock"));
}

// A record of the beam with 0.27 kg under a description with 0.71 kg: f1 is 40 % off.
TEST(ModelCheck, FindsAMassThatIsWrongByAFactor) {
  for (const int modes : {1, 3}) {
    const ModelCheck check = check_model({structure(cantilever(0.71), "tip_mass", 0.27 - 0.71, modes)}, {});
    ASSERT_EQ(check.modes.size(), static_cast<std::size_t>(modes));
    EXPECT_TRUE(check.modes[0].far);
    const auto tip = std::find_if(check.single.begin(), check.single.end(), [&](const Explanation& one) {
      return candidate_of(check, one).name == "tip_mass";
    });
    EXPECT_NEAR(tip->change[0], 0.27 - 0.71, 1e-3);
    EXPECT_THAT(testing::PrintToString(conclusions(check)), HasSubstr("ip mass 0.27 instead of 0.71 kg"));
  }
}

// Two records of the beam and one of a lighter one; the modes as their merging leaves them.
TEST(ModelCheck, NamesTheRecordThatContradictsTheOthers) {
  CheckedStructure beam = structure(cantilever(0.71), "", 0, 1);
  beam.modes[0].records = {"a.csv", "b.csv"};
  beam.modes.push_back({1.43 * beam.modes[0].frequency_hz, 1e-3, 0.01, 1e-4, {}, {"c.csv"}});
  const ModelCheck check = check_model({beam}, {});
  ASSERT_EQ(check.contradictions.size(), 1u);
  EXPECT_THAT(check.contradictions[0], HasSubstr("c.csv contradicts a.csv, b.csv: mode 1"));
  EXPECT_TRUE(check.strays.empty());           // not a neighbour as well
  beam.modes[1].records = {"a.csv", "c.csv"};  // beside mode 1 in one record: another motion
  EXPECT_TRUE(check_model({beam}, {}).contradictions.empty());
}

// Four tip masses, one description far off: it is named and does not spoil the others, which agree.
TEST(ModelCheck, LeavesOutTheStructureThatContradictsTheOthers) {
  std::vector<CheckedStructure> several;
  for (const double mass : {1.4, 0.71, 0.27})
    several.push_back(structure(cantilever(mass), "tip_mass", mass == 0.71 ? 0.27 - 0.71 : 0.0, 1));
  several[0].name = "heavy", several[1].name = "middle", several[2].name = "light";
  const ModelCheck check = check_model(several, {});
  EXPECT_TRUE(check.right);
  ASSERT_EQ(check.contradictions.size(), 1u);
  EXPECT_THAT(check.contradictions[0], HasSubstr("middle contradicts the others"));
  EXPECT_THAT(check.contradictions[0], HasSubstr("light predicts"));
  several[1] =
      structure(cantilever(0.71), "bending_stiffness", -0.3, 1);  // 16 % off: within reach of its mode
  several[1].name = "middle";
  const ModelCheck near = check_model(several, {});
  ASSERT_TRUE(near.outlier.has_value());
  EXPECT_EQ(near.outlier->structure, 1u);
  EXPECT_THAT(testing::PrintToString(conclusions(near)), HasSubstr("middle contradicts the others"));
}

TEST(ModelCheck, RefusesCandidatesThatAreNone) {
  const CheckedStructure beam = structure(cantilever(0), "", 0, 2);
  EXPECT_THROW(check_model({beam}, {0.005, {"clamp"}}), std::invalid_argument);
  EXPECT_THROW(check_model({beam}, {0.005, {"tip_offset"}}), std::invalid_argument);  // no mass there
}

}  // namespace
}  // namespace beamid::experiments::model_check_test
