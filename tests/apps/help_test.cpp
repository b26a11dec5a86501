// What the command says of itself.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::help_test {
namespace {

using testing::HasSubstr, testing::IsEmpty, testing::MatchesRegex, testing::StartsWith;

TEST(Beamid, TellsItsVersion) {
  const Outcome outcome = Workplace().run("--version");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, MatchesRegex("beamid [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_THAT(outcome.err, IsEmpty());
}

TEST(Beamid, WithoutWordsShowsHelpAsAnError) {
  const Outcome bare = Workplace().run(""), asked = Workplace().run("--help");
  EXPECT_EQ(bare.code, 2);
  EXPECT_THAT(bare.out, IsEmpty());
  EXPECT_EQ(asked.code, 0);
  EXPECT_EQ(asked.out, bare.err);
}

class EveryCommand : public testing::TestWithParam<const char*> {};

TEST_P(EveryCommand, IsNamedInTheHelp) {
  EXPECT_THAT(Workplace().run("--help").out, HasSubstr("\n  " + std::string(GetParam()) + " "));
}

TEST_P(EveryCommand, ExplainsItselfWithExamples) {
  const Outcome outcome = Workplace().run(GetParam() + std::string(" --help"));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, StartsWith("beamid " + std::string(GetParam()) + " "));
  EXPECT_THAT(outcome.out, HasSubstr("\nExamples\n  beamid " + std::string(GetParam())));
}

TEST_P(EveryCommand, RefusesAnUnknownOption) {
  const Outcome outcome = Workplace().run(GetParam() + std::string(" --zzzzzz 1"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_EQ(outcome.first_error_line(),
            "beamid: " + std::string(GetParam()) + ": unrecognised option '--zzzzzz'");
}

INSTANTIATE_TEST_SUITE_P(All, EveryCommand,
                         testing::Values("budget", "noise", "paper", "inspect", "prepare", "modal",
                                         "identify", "check", "update", "twins", "posterior", "steps",
                                         "track", "backbone", "sense", "substructures", "stream", "compare",
                                         "identifiability", "efficiency", "sweep", "modes", "frame",
                                         "simulate", "frf", "reduce", "new", "validate", "list", "report",
                                         "help", "completion"),
                         [](const auto& tested) { return std::string(tested.param); });

// The everyday ones stand first.
TEST(UnknownCommand, IsAnsweredWithTheKnownOnes) {
  const Outcome outcome = Workplace().run("quaternion");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_EQ(
      outcome.first_error_line(),
      "beamid: unknown command 'quaternion'; known: inspect, modal, identify, modes, simulate, "
      "compare, report, prepare, track, backbone, stream, check, steps, sense, substructures, update, twins, "
      "posterior, frf, frame, reduce, "
      "identifiability, sweep, "
      "efficiency, "
      "atlas, budget, noise, paper, new, validate, list, completion, help");
}

struct Kind {
  const char* name;
  std::vector<std::string> members;
};

void PrintTo(const Kind& tested, std::ostream* stream) {
  *stream << tested.name;
}

class ListOf : public testing::TestWithParam<Kind> {};

TEST_P(ListOf, NamesEveryMember) {
  const Outcome outcome = Workplace().run(std::string("list ") + GetParam().name);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  for (const std::string& member : GetParam().members)
    EXPECT_THAT(outcome.out, HasSubstr("\n" + member + " "));
}

INSTANTIATE_TEST_SUITE_P(Kinds, ListOf,
                         testing::Values(Kind{"filters", {"ekf", "low_rank_ekf", "low_rank_ukf", "ukf"}},
                                         Kind{"reductions", {"none", "rayleigh", "modal_truncation"}},
                                         Kind{"discretisations",
                                              {"forward_euler", "backward_euler", "implicit_midpoint", "pade",
                                               "runge_kutta_2", "runge_kutta_4", "exponential", "cvode"}},
                                         Kind{"modal_methods", {"era", "frf_lscf", "ssi_cov"}},
                                         Kind{"models", {"beam", "modal", "sdof"}},
                                         Kind{"readers", {"delimited_text", "hdf5", "lvm", "mat", "uff58"}},
                                         Kind{"steps", {"band_pass", "event", "integrate", "resample"}},
                                         Kind{"studies", {"atlas", "budget", "noise", "paper"}},
                                         Kind{"smoothers", {"rts", "urts"}},
                                         Kind{"springs", {"bouc_wen", "duffing", "hyperbolic", "linear"}},
                                         Kind{"responses",
                                              {"modal", "newmark", "hht_alpha", "generalised_alpha"}}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(ListOfOneFilter, ShowsItsOptionsWithDefaults) {
  const Outcome outcome = Workplace().run("list filters ukf");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, StartsWith("ukf: "));
  for (const char* option : {"\nalpha   1 ", "\nbeta    2 ", "\nkappa   0 "})
    EXPECT_THAT(outcome.out, HasSubstr(option));
}

// Oracle: filters/methods/ukf.cpp and docs/references.md.
TEST(ListOfOneFilter, TellsSourcesInFullWordsAndPromises) {
  const Outcome outcome = Workplace().run("list filters ukf");
  EXPECT_THAT(outcome.out, HasSubstr("\nsource: [julier2004], [julier2002], [wan2000]\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\n- S. J. Julier, J. K. Uhlmann: Unscented filtering and nonlinear"));
  EXPECT_THAT(outcome.out, HasSubstr("doi:10.1109/JPROC.2003.823141"));
  EXPECT_THAT(outcome.out, HasSubstr("\n- its covariance is that of its errors\n"));
}

TEST(ListOfOneFilter, ShowsUnitsOfItsOptions) {
  EXPECT_THAT(Workplace().run("list responses cvode").out, HasSubstr("\noption "));
  EXPECT_THAT(Workplace().run("list filters ekf").out, HasSubstr("\nno options\n"));
}

// The place in a book that a source names stays with it.
TEST(ListOfOneDiscretisation, NamesTheChapterOfItsSource) {
  std::string text = Workplace().run("list discretisations pade").out;
  for (char& letter : text)
    if (letter == '\n') letter = ' ';
  EXPECT_THAT(text, HasSubstr("E. Hairer, G. Wanner: Solving Ordinary"));
  EXPECT_THAT(text, HasSubstr(", ch. IV.3"));
}

TEST(List, WithoutAKindShowsEveryEntryWithItsOptions) {
  const Outcome outcome = Workplace().run("list");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  for (const char* part : {"discretisations\n\n", "\nfilters\n\n", "\nmodal_methods\n\n", "\nmodels\n\n",
                           "\nreductions\n\n", "\nresponses\n\n", "\nsmoothers\n\n", "\nstudies\n\n",
                           "\nukf ", "\nrts ", "\nsdof ", "\nnewmark ", "alpha = 1, beta = 2, kappa = 0"})
    EXPECT_THAT(outcome.out, HasSubstr(part));
}

// Oracle: docs/configuration.md.
TEST(List, OfKeysShowsTheTablesOfAnExperimentFileAndTheKeysOfOne) {
  const Outcome tables = Workplace().run("list keys");
  EXPECT_EQ(tables.code, 0);
  for (const char* part : {"[beam]", "[[beam.springs]]", "[sweep]", "tip_mass_kg", "options of the method"})
    EXPECT_THAT(tables.out, HasSubstr(part));
  const Outcome springs = Workplace().run("list keys beam.springs");
  EXPECT_EQ(springs.code, 0);
  for (const char* part :
       {"[[beam.springs]]", "translational_n_per_m", "number >= 0", "N/m", "k of a force k w"})
    EXPECT_THAT(springs.out, HasSubstr(part));
  EXPECT_EQ(Workplace().run("list keys beam.sprigs").first_error_line(),
            "beamid: unknown table 'beam.sprigs' of an experiment file; did you mean 'beam.springs'?");
}

TEST(List, RefusesUnknownKindsAndNames) {
  EXPECT_EQ(Workplace().run("list quaternions").first_error_line(),
            "beamid: list: unknown kind 'quaternions'; known: discretisations, filters, keys, modal_methods, "
            "models, objections, "
            "readers, reductions, responses, smoothers, springs, steps, studies");
  EXPECT_EQ(Workplace().run("list filters quaternion").first_error_line(),
            "beamid: unknown filter 'quaternion'; known: adaptive_ekf, ckf, dual_ekf, dual_kf, ekf, enkf, "
            "gillijns_de_moor, iekf, kf, low_rank_ekf, "
            "low_rank_ukf, particle, rao_blackwellised, robust_ekf, srckf, srukf, ukf");
  EXPECT_EQ(Workplace().run("list filters ufk").code, 2);
}

}  // namespace
}  // namespace beamid::apps::help_test
