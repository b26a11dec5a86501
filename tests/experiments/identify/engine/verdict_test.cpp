// What a comparison says of its runs. Oracles: the beam simulated; the closed form of a scheme; the posterior
// mean of a parameter that the record does not tell, which is the prior's.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/studies/compare/report.hpp"

namespace beamid::experiments::verdict_test {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

const Progress silent = [](const std::string&) {};

Experiment cantilever(const std::string& more, const std::vector<std::string>& reductions,
                      const std::string& beam = "") {
  Experiment e = read_experiment(
      TomlTable::parse("[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = "
                       "2.12e11\nmass_kg = 3.055\nelements = 20\ntip_mass_kg = 0.36\n" +
                           beam + "[damping]\nratio = 0.004\n" + more,
                       "test.toml"));
  for (const std::string& text : reductions) e.reductions.push_back(parse_reduction(text, "test"));
  if (e.filters.empty()) e.filters = {e.filter};
  if (e.discretisations.empty()) e.discretisations = {e.discretisation};
  return e;
}

Comparison compared(const Experiment& e) {
  return compare(e, simulated_record(e, {}, silent), {}, silent);
}

const std::string sensor = "[[sensors]]\nname = \"tip\"\nnoise_m_per_s2 = 0.05\n";
const std::string ask_stiffness =
    "[model]\nname = \"beam\"\n[[parameters]]\nquantity = \"bending_stiffness\"\nguess_n_m2 = 215\n"
    "[[parameters]]\nquantity = \"damping_ratio\"\nguess = 0.003\n";

// The lists that a command line would complete.
TEST(Verdict, AStepTooLongIsNamedAsTheCause) {
  // omega dt = 1.09: the classical Runge-Kutta step takes (omega dt)^5 / 144 = 1.05 % off the ratio.
  const Comparison found =
      compared(cantilever("[simulation]\nduration_s = 10\nsampling_rate_hz = 20\n" + sensor + ask_stiffness +
                              "[compare]\ndiscretisations = [\"exponential\", \"runge_kutta_4\"]\n",
                          {"modal_truncation"}));
  EXPECT_EQ(found.runs[0].status, ComparedRun::Status::converged) << found.runs[0].reason;
  EXPECT_EQ(found.runs[0].step_cause, "");
  EXPECT_EQ(found.runs[1].status, ComparedRun::Status::diverged);
  EXPECT_THAT(found.runs[1].reason, HasSubstr("its damping ratio is -"));
  EXPECT_THAT(words(found), Contains(HasSubstr("runge_kutta_4: runge_kutta_4 with steps of 0.05 s")));
}

// A static shape is stiffer than the mode, so that less bending stiffness makes the record's frequency.
// Oracle: the beam simulated, whose stiffness the sentence gives to a tenth of the error.
TEST(Verdict, AReductionThatMovesTheModeIsNamed) {
  const Comparison found =
      compared(cantilever("[simulation]\nduration_s = 10\nsampling_rate_hz = 100\n" + sensor + ask_stiffness,
                          {"rayleigh", "modal_truncation", "none"}));
  const ComparedRun& wrong = found.runs.at(0);
  const double error = 100.0 * (wrong.parameters.at(0).estimate.value / *wrong.parameters.at(0).truth - 1.0);
  ASSERT_LT(error, -1.0);
  ASSERT_FALSE(wrong.objections.empty());
  const std::string text = wrong.objections.at(0).text;
  EXPECT_THAT(text, testing::StartsWith("WRONG BY THE REDUCTION: "));
  const std::string before = "Stiffness comes out wrong by about ";
  ASSERT_NE(text.find(before), std::string::npos);
  EXPECT_NEAR(std::stod(text.substr(text.find(before) + before.size())), error, 0.1 * std::abs(error));
  for (const std::size_t right : {1u, 2u})
    EXPECT_THAT(texts(found.runs.at(right).objections), Not(Contains(HasSubstr("REDUCTION"))));
}

TEST(Verdict, FiltersThatAgreeAreSaidToAgree) {
  const Comparison found =
      compared(cantilever("[simulation]\nduration_s = 5\nsampling_rate_hz = 100\n" + sensor + ask_stiffness +
                              "[[filters]]\nmethod = \"ukf\"\n[[filters]]\nmethod = \"ekf\"\n",
                          {"modal_truncation"}));
  EXPECT_THAT(words(found), Contains(HasSubstr("ekf agrees with ukf within")));
  EXPECT_THAT(words(found), Not(Contains(HasSubstr("ukf agrees with ekf"))));
  EXPECT_THAT(words(found), Not(Contains(HasSubstr(" faster"))));  // times are no result
}

TEST(Verdict, AnAliasedRecordIsRecognisedAndIdentified) {
  const Experiment e = cantilever(
      "[simulation]\nduration_s = 20\nsampling_rate_hz = 5\n" + sensor + ask_stiffness, {"modal_truncation"});
  const ComparedRecord record = simulated_record(e, {}, silent);
  EXPECT_THAT(record.notes, Contains(HasSubstr("no mode lies below half the sampling rate, 2.5 Hz")));
  const Comparison found = compare(e, record, {}, silent);
  EXPECT_THAT(texts(found.objections), Contains(HasSubstr("ALIASED: the beam's first mode")));
  EXPECT_EQ(found.runs[0].status, ComparedRun::Status::converged) << found.runs[0].reason;
}

TEST(Verdict, ADeadChannelIsRefusedByName) {
  const Experiment e =
      cantilever("[simulation]\nduration_s = 2\nsampling_rate_hz = 100\n" + sensor, {"modal_truncation"});
  ComparedRecord record = simulated_record(e, {}, silent);
  record.record.samples.row(0).setConstant(0.3);
  EXPECT_THAT(
      [&] { compare(e, record, {}, silent); },
      testing::ThrowsMessage<std::invalid_argument>(HasSubstr("channel 'tip' is dead: it shows 0.3 m/s2")));
}

TEST(Verdict, TheForceOfASimulatedTestIsInItsRecord) {
  const Experiment e = cantilever(
      "[excitation]\nkind = \"harmonic\"\namplitude_n = 1\nfrequency_hz = 3.2\nposition_m = 0.55\n"
      "[simulation]\nduration_s = 5\nsampling_rate_hz = 400\nmodes = 3\n" +
          sensor + ask_stiffness,
      {"modal_truncation:modes=3"});
  const ComparedRecord record = simulated_record(e, {}, silent);
  ASSERT_EQ(record.record.channels.size(), 2u);
  EXPECT_EQ(record.record.channels[1].quantity, Quantity::force);
  EXPECT_EQ(record.record.channels[1].position, 0.55);
  EXPECT_NEAR(record.record.samples.row(1).maxCoeff(), 1.0, 1e-3);
  const Comparison found = compare(e, record, {}, silent);
  const ComparedRun& run = found.runs[0];
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  // Without the force: E I 0.1 to 2 % off, ratio -63 to -102 %.
  EXPECT_NEAR(*run.parameters[0].error_percent(), 0.0, 0.02);
  EXPECT_NEAR(*run.parameters[1].error_percent(), 0.0, 1.0);
}

// The basis follows the estimate: shapes of the initial estimate's beam, with a tip mass 16 % too light, take
// the ratio 7 % off, 71 standard deviations.
TEST(Basis, OfAReductionIsThatOfTheEstimate) {
  const Experiment e = cantilever(
      "[simulation]\nduration_s = 4\nsampling_rate_hz = 500\nseed = 5\n" + sensor +
          "[model]\nname = \"beam\"\n[[parameters]]\nquantity = \"bending_stiffness\"\nguess_n_m2 = 215\n"
          "[[parameters]]\nquantity = \"tip_mass\"\nguess_kg = 0.30\ndeviation_kg = 0.1\n"
          "[[parameters]]\nquantity = \"damping_ratio\"\nguess = 0.003\n",
      {"modal_truncation:modes=5"});
  for (const ComparedRun& run : compared(e).runs) {
    ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
    for (const ComparedParameter& p : run.parameters)
      EXPECT_LT(std::abs(p.estimate.value - *p.truth), 4.0 * p.estimate.deviation)
          << run.reduction << " " << p.estimate.name;
  }
}

TEST(Passes, DoNotMoveWhatTheRecordDoesNotTell) {
  // The third mode's ratio, with the noise two hundred times its share of the motion.
  const auto ratio_after = [](int passes) {
    Experiment e = cantilever(
        "[simulation]\nduration_s = 4\nsampling_rate_hz = 200\nseed = 8\n"
        "[[sensors]]\nname = \"tip\"\nquantity = \"displacement\"\nnoise_m = 1e-4\n[model]\nname = \"beam\"\n"
        "[[parameters]]\nquantity = \"bending_stiffness\"\nguess_n_m2 = 225\n"
        "[[parameters]]\nquantity = \"damping_ratio\"\nmode = 1\n"
        "[[parameters]]\nquantity = \"damping_ratio\"\nmode = 3\nguess = 0.005\ndeviation = 0.004\n",
        {"modal_truncation:modes=3"});
    e.passes = passes;
    return compared(e).runs[0].parameters[2].estimate;
  };
  const Estimate few = ratio_after(4), often = ratio_after(12);
  EXPECT_GT(often.deviation, 0.003);  // of 0.004 beforehand
  EXPECT_NEAR(often.value, few.value, 0.05 * 0.004);
}

// Two hundred particles for a posterior thousands of times narrower than the prior end as a few copies.
TEST(Verdict, NoDeviationIsBelowTheBound) {
  const Comparison found =
      compared(cantilever("[simulation]\nduration_s = 4\nsampling_rate_hz = 100\n" + sensor + ask_stiffness +
                              "[[filters]]\nmethod = \"particle\"\nparticles = 200\nregularise = false\n",
                          {"modal_truncation"}));
  const ComparedRun& run = found.runs[0];
  ASSERT_TRUE(run.has_estimate()) << run.reason;
  double least = 1.0;
  for (const ComparedParameter& p : run.parameters) {
    ASSERT_TRUE(p.bound);
    least = std::min(least, p.overconfidence);
    EXPECT_GE(p.estimate.deviation, 0.79 / std::hypot(1.0 / *p.bound, 1.0 / p.estimate.prior_deviation));
  }
  EXPECT_LT(least, 0.5);
  EXPECT_EQ(run.status, ComparedRun::Status::contradicted);
  EXPECT_THAT(run.reason, HasSubstr("standard deviation of bending_stiffness"));
}

// A root as stiff as 1e9 N m/rad stores no energy: no record tells it from a stiffer one.
TEST(Verdict, WhatTheRecordDoesNotTellIsNamed) {
  const Comparison found = compared(
      cantilever("[simulation]\nduration_s = 4\nsampling_rate_hz = 100\n" + sensor + ask_stiffness +
                     "[[parameters]]\nquantity = \"root_rotational_stiffness\"\nform = \"logarithmic\"\n"
                     "relative_deviation = 0.3\n",
                 {"modal_truncation"}, "root_rotational_stiffness_n_m_per_rad = 1e9\n"));
  const ComparedRun& run = found.runs[0];
  ASSERT_TRUE(run.has_estimate()) << run.reason;
  EXPECT_THAT(
      texts(run.objections),
      Contains(HasSubstr("NOT DETERMINED: root_rotational_stiffness (1): the record determines no more")));
  const Comparison known =
      compared(cantilever("[simulation]\nduration_s = 4\nsampling_rate_hz = 100\n" + sensor + ask_stiffness,
                          {"modal_truncation"}));
  EXPECT_THAT(texts(known.runs[0].objections), Not(Contains(HasSubstr("NOT DETERMINED"))));
}

TEST(Words, BlameCollapsedParticlesAndNoNestedShapes) {
  Comparison comparison;
  ComparedRun run;
  run.reduction = "modal_truncation";
  run.filter = "particle:particles=1000";
  run.discretisation = "exponential";
  run.coordinates = 3;
  run.response_error_percent = 2.0;
  run.noise = run.noise_left = Eigen::VectorXd::Ones(1);
  ComparedParameter p;
  p.estimate.name = "bending_stiffness";
  p.estimate.value = 200.0;
  p.estimate.deviation = 1.0;
  p.estimate.prior_deviation = 60.0;
  p.bound = 1.0;
  p.overconfidence = 0.01;
  run.parameters = {p};
  ComparedRun guyan = run;
  guyan.reduction = "guyan:positions=0.2 0.4";
  guyan.filter = "ekf";
  guyan.coordinates = 6;
  guyan.response_error_percent = 4.0;
  guyan.parameters[0].overconfidence = 1.0;
  ComparedRun smaller = guyan;
  smaller.reduction = "modal_truncation";
  smaller.coordinates = 3;
  smaller.response_error_percent = 2.0;
  comparison.compared.record.channels = {{Quantity::acceleration, "tip"}};
  comparison.runs = {run, guyan, smaller};
  EXPECT_THAT(words(comparison), Contains(HasSubstr("its particles have collapsed")));
  EXPECT_THAT(words(comparison), Not(Contains(HasSubstr("wrong answer"))));
  guyan.reduction = "modal_truncation:modes=6";
  comparison.runs = {guyan, smaller};
  EXPECT_THAT(words(comparison), Contains(HasSubstr("Larger residual than a smaller model: ")));
}

TEST(Verdict, AnEstimateThatStillMovesIsNotSettled) {
  const auto words_after = [](int passes) {
    Experiment e =
        cantilever("[simulation]\nduration_s = 4\nsampling_rate_hz = 200\n" + sensor +
                       "[model]\nname = \"beam\"\n[[parameters]]\nquantity = \"bending_stiffness\"\n"
                       "guess_n_m2 = 90\n[[parameters]]\nquantity = \"tip_mass\"\nguess_kg = 2.5\n"
                       "deviation_kg = 3\n",
                   {"modal_truncation:modes=3"});
    e.passes = passes;
    return words(compared(e));
  };
  EXPECT_THAT(words_after(1), Contains(HasSubstr("Not settled")));
  EXPECT_THAT(words_after(6), Not(Contains(HasSubstr("Not settled"))));
}

TEST(ModelBeam, HasOneExactModeUnlessAReductionIsChosen) {
  EXPECT_EQ(cantilever("[model]\nname = \"beam\"\n", {}).reduction.name, "modal_truncation");
  EXPECT_EQ(cantilever("[model]\nname = \"beam\"\n[reduction]\nmethod = \"rayleigh\"\n", {}).reduction.name,
            "rayleigh");
  EXPECT_EQ(cantilever("", {}).reduction.name, "rayleigh");
}

TEST(ModelBeam, IsWarnedWhereTheModalAnalysisSaysOtherwise) {
  // forward Euler at 2.5 ms makes the damping ratio 2.7 % more than it is, in absolute terms.
  Experiment e = cantilever("[simulation]\nduration_s = 4\nsampling_rate_hz = 400\nmodes = 4\n" + sensor +
                                ask_stiffness + "[filter]\ndiscretisation = \"forward_euler\"\n",
                            {"modal_truncation"});
  EXPECT_THAT(texts(compared(e).runs[0].objections), Contains(HasSubstr("DISAGREE: ")));
}

}  // namespace
}  // namespace beamid::experiments::verdict_test
