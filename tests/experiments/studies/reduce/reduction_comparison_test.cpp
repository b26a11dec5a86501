// Oracles: the table of the five test beams (frequency errors of Rayleigh's shapes, equivalent masses, modal
// amplitudes after a release), computed outside this project; models that equal the mesh by construction.
#include "experiments/studies/reduce/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/config/readers.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments::reduction_comparison_test {
namespace {

using std::numbers::pi;

Experiment beam_of(double tip_mass) {
  Experiment experiment;
  experiment.structure = fem::Beam(test::steel_beam(tip_mass));
  return experiment;
}

ReductionComparison compared(const Experiment& experiment, const std::vector<std::string>& texts,
                             int modes = 3) {
  std::vector<Choice> choices;
  for (const std::string& text : texts) choices.push_back(parse_reduction(text, "--reduction"));
  return compare_reductions(experiment, choices, {modes, 20.0}, {}, [](const std::string&) {});
}

TEST(ReductionComparison, ShowsTheTabulatedErrorsOfRayleighsShapes) {
  const double static_shape[] = {1.38833, 0.65267, 0.17907, 0.08120, 0.03957};
  const double cosine[] = {4.07, 2.70, 1.59, 1.27, 1.09};
  for (int i = 0; i < 5; ++i) {
    const double tip_mass = test::five_beams[i].tip_mass;
    const auto all = compared(beam_of(tip_mass), {"rayleigh", "rayleigh:shape=one_minus_cosine"});
    const ComparedReduction &by_load = all.reductions[0], &by_cosine = all.reductions[1];
    EXPECT_NEAR(100.0 * by_load.frequency_error[0], static_shape[i], 5e-5);
    EXPECT_NEAR(100.0 * by_cosine.frequency_error[0], cosine[i], 5e-3);
    EXPECT_NEAR(by_load.behaviour.modal_mass, 33.0 / 140.0 * 3.055 + tip_mass, 1e-6);
    EXPECT_NEAR(by_load.behaviour.static_stiffness, 516.063, 5e-4);
    EXPECT_NEAR(by_cosine.behaviour.modal_mass, (1.5 - 4.0 / pi) * 3.055 + tip_mass, 1e-6);
    EXPECT_NEAR(by_cosine.behaviour.static_stiffness / 516.063, std::pow(pi, 4) / 96.0, 1e-6);
    EXPECT_NEAR(all.behaviour.modal_mass, test::five_beams[i].modal_mass_at_tip, 1e-6);
    EXPECT_EQ(by_load.partner, (std::vector<Eigen::Index>{0, -1, -1}));  // one coordinate has no second mode
    EXPECT_TRUE(std::isnan(by_load.frequency_error[1]));
  }
}

TEST(ReductionComparison, FindsTheMeshsOwnModesInTheirTruncation) {
  const ReductionComparison all = compared(beam_of(0.36049), {"modal_truncation:modes=3"});
  const ComparedReduction& one = all.reductions[0];
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(one.mac[i], 1.0, 1e-12);
    EXPECT_NEAR(one.deflection_mac[i], 1.0, 1e-12);
    EXPECT_NEAR(one.frequency_error[i], 0.0, 1e-9);
  }
  for (Eigen::Index p = 1; p < one.comac.size(); ++p) EXPECT_NEAR(one.comac[p], 1.0, 1e-10);
  EXPECT_NEAR(one.modal_mass_error, 0.0, 1e-9);
  EXPECT_LT(one.static_stiffness_error, 1.0);
  EXPECT_GT(one.static_stiffness_error, 0.0);  // fewer modes, stiffer
}

TEST(ReductionComparison, FindsNoErrorWhereNothingIsLeftOut) {
  Experiment experiment = beam_of(0.0198575);
  experiment.elements = 10;
  const auto all = compared(experiment, {"none", "modal_truncation:modes=20"});
  for (const ComparedReduction& one : all.reductions) {
    EXPECT_LT(one.displacement_error, 1e-7) << one.label;
    EXPECT_LT(one.acceleration_error, 1e-7) << one.label;
    EXPECT_LT(one.response_error, 1e-6) << one.label;
    EXPECT_NEAR(one.static_stiffness_error, 0.0, 1e-9) << one.label;
    EXPECT_NEAR(one.mac.minCoeff(), 1.0, 1e-9) << one.label;
  }
}

// The modes that one mode leaves out, mode by mode: over T the squared motion of a decaying mode integrates
// to a^2 (1 - e^(-2 xi w T)) / (4 xi w), and different modes are orthogonal but for a few parts in a
// thousand.
double hand_sum(const double (&amplitude)[5], const double (&acceleration)[5],
                const double (&displacement)[5]) {
  double all = 0.0, left_out = 0.0, first = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double omega = std::sqrt(1e3 * acceleration[i] / displacement[i]), ratio = 0.005;
    if (i == 0) first = omega;
    const double share =
        amplitude[i] * amplitude[i] * (1.0 - std::exp(-2.0 * ratio * omega * 20.0 * pi / first)) / omega;
    all += share;
    if (i > 0) left_out += share;
  }
  return std::sqrt(left_out / all);
}

// S(0.65), whose record at 600 Hz holds five modes: a single mode errs by 2 % of the displacement and by two
// thirds of the acceleration.
TEST(ReductionComparison, TellsDisplacementAndAccelerationApart) {
  const double displacement[] = {11.6663, 0.28420, 0.034836, 0.008710, 0.003061};
  const double acceleration[] = {7.915, 7.577, 7.285, 6.998, 6.724};
  Experiment experiment = beam_of(0.0198575);
  experiment.simulation.sampling_rate = 600.0;
  const auto all = compared(experiment, {"modal_truncation:modes=1"});
  const ComparedReduction& one = all.reductions[0];
  EXPECT_NEAR(one.displacement_error / hand_sum(displacement, acceleration, displacement), 1.0, 0.03);
  EXPECT_NEAR(one.acceleration_error / hand_sum(acceleration, acceleration, displacement), 1.0, 0.03);
  EXPECT_LT(one.displacement_error, 0.02);
  EXPECT_GT(one.acceleration_error, 0.5);
}

// A mode's error does not depend on how many elements the mesh has: that is what the limit is for.
TEST(ReductionComparison, OfAccelerationsDoesNotDependOnTheMesh) {
  Experiment coarse = beam_of(0.0198575), fine = coarse;
  fine.elements = 160;
  const double one = compared(coarse, {"rayleigh"}).reductions[0].acceleration_error,
               other = compared(fine, {"rayleigh"}).reductions[0].acceleration_error;
  EXPECT_NEAR(one / other, 1.0, 1e-3);
}

TEST(ReductionComparison, AssumesADampingAndSaysSo) {
  Experiment experiment = beam_of(0.0);
  EXPECT_TRUE(compared(experiment, {"rayleigh"}).damping_assumed);
  experiment.damping = fem::ModalDamping{{0.01}};
  EXPECT_FALSE(compared(experiment, {"rayleigh"}).damping_assumed);
  experiment.damping = {};
  experiment.structure.beam().dashpots.push_back({1.1, 0.05, 0.0, 0.0});
  EXPECT_FALSE(compared(experiment, {"rayleigh"}).damping_assumed);
}

TEST(ReductionComparison, OfAnUndampedBeamHasNoResponseError) {
  Experiment experiment = beam_of(0.0);
  experiment.damping = fem::ModalDamping{{0.0}};
  const ReductionComparison all = compared(experiment, {"modal_truncation:modes=3"});
  EXPECT_TRUE(std::isnan(all.reductions[0].response_error));
  EXPECT_LT(all.reductions[0].displacement_error, 0.02);
}

TEST(ReductionComparison, OfAFreeBeamHasNoDecay) {
  Experiment experiment = beam_of(0.0);
  experiment.structure.beam().supports.clear();
  const ReductionComparison all = compared(experiment, {"modal_truncation:modes=4"}, 2);
  EXPECT_EQ(all.modes.modes.rigid, 2);
  EXPECT_EQ(all.release.samples, 0);
  EXPECT_NEAR(all.reductions[0].mac[1], 1.0, 1e-9);
  EXPECT_LT(all.reductions[0].response_error, 0.2);
  EXPECT_TRUE(std::isnan(all.reductions[0].displacement_error));
}

TEST(ReductionComparison, LeavesOutWhatNobodyAskedForAndRefusesTheRest) {
  Experiment experiment = beam_of(0.0);
  experiment.structure.beam().supports.clear();
  EXPECT_THROW(compared(experiment, {"rayleigh"}), InputError);  // no static shape
  std::vector<Choice> choices{parse_reduction("rayleigh", ""),
                              parse_reduction("modal_truncation:modes=4", "")};
  const auto all = compare_reductions(experiment, choices, {2, 20.0}, {}, [](const std::string&) {});
  ASSERT_EQ(all.reductions.size(), 1u);
  EXPECT_TRUE(all.notes.back().starts_with("rayleigh is excluded: ")) << all.notes.back();
}

// A stiff little beam: a record at 1 kHz would hold less than a sample of a period.
TEST(ReductionComparison, SamplesAStiffBeamFaster) {
  Experiment experiment = beam_of(0.0);
  for (auto& segment : experiment.structure.beam().segments) segment.length *= 0.02;
  experiment.structure.beam().supports = {{0.0, true, true}};
  const ReductionComparison all = compared(experiment, {"rayleigh"});
  EXPECT_NEAR(all.release.sampling_rate_hz / all.mode_hz(0), 250.0, 1e-9);
}

}  // namespace
}  // namespace beamid::experiments::reduction_comparison_test
