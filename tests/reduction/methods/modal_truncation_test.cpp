// Mode shapes, and what they leave out.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "reduction/reduction.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::modal_truncation_test {
namespace {

using Eigen::MatrixXd;
using reduction::reduction_registry;

TEST(ModalTruncation, OneModeHasTheTrueModalMassAtTheTip) {
  // Oracle: modal masses of the five beams, from exact mode shapes, computed outside this project.
  for (const auto& known : test::five_beams) {
    const auto model = reduce(assemble(test::steel_beam(known.tip_mass), 80),
                              *reduction_registry().make("modal_truncation", {}));
    EXPECT_NEAR(model.system.mass.coeff(0, 0), known.modal_mass_at_tip, 6e-7);
  }
}

TEST(ModalTruncation, WithEveryModeIsNoReduction) {
  const auto system = assemble(test::steel_beam(0.36049), 10);
  const auto model = reduce(system, *reduction_registry().make("modal_truncation", {{"modes", 20.0}}));
  EXPECT_NEAR(static_stiffness(model.system) / static_stiffness(system), 1.0, 1e-9);
}

TEST(ModalTruncation, StaticCorrectionMakesEveryForceExactAtRest) {
  // Oracle: flexibility of the full system between all points.
  const auto system = assemble(test::steel_beam(0.36049), 40, {{"a", 0.33}, {"b", 0.66}, {"tip", 1.1}});
  const auto model = reduce(
      system, *reduction_registry().make("modal_truncation", {{"modes", 2.0}, {"static_correction", true}}));
  EXPECT_EQ(model.system.size(), 5);
  for (int input = 0; input < 3; ++input)
    for (int output = 0; output < 3; ++output)
      EXPECT_NEAR(static_stiffness(model.system, input, output) / static_stiffness(system, input, output),
                  1.0, 1e-9);
  const fem::Modes full = fem::modes(system, 2), reduced = fem::modes(model.system, 2);
  EXPECT_NEAR(reduced.angular_frequency[1] / full.angular_frequency[1], 1.0, 1e-10);
}

TEST(ModalTruncation, LeavesOutVectorsThatSayNothingNew) {
  // Oracle: two forces at one place have one static shape; all modes leave nothing out.
  const auto twice = assemble(test::steel_beam(0.0), 10, {{"tip", 1.1}, {"end", 1.1}});
  const auto corrected = [&](double modes) {
    const auto method =
        reduction_registry().make("modal_truncation", {{"modes", modes}, {"static_correction", true}});
    return reduce(twice, *method).system.size();
  };
  EXPECT_EQ(corrected(3.0), 4);
  EXPECT_EQ(corrected(20.0), 20);
}

TEST(ModalTruncation, StaticCorrectionServesAFreeBeam) {
  // Oracle: the elastic deflection under a force that the beam's own inertia balances, from all modes but the
  // rigid ones, sum of (H phi)^2 / omega^2.
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports.clear();
  const auto system = assemble(beam, 20);
  const auto deflection = [](const fem::StructuralSystem& any) {
    const fem::Modes modes = fem::modes(any, any.size());
    const MatrixXd seen = any.outputs * modes.shape;
    double sum = 0.0;
    for (Eigen::Index i = modes.rigid; i < modes.size(); ++i)
      sum += std::pow(seen(0, i) / modes.angular_frequency[i], 2);
    return sum;
  };
  const auto model = reduce(
      system, *reduction_registry().make("modal_truncation", {{"modes", 3.0}, {"static_correction", true}}));
  EXPECT_EQ(model.system.size(), 4);
  EXPECT_NEAR(deflection(model.system) / deflection(system), 1.0, 1e-9);
}

}  // namespace
}  // namespace beamid::modal_truncation_test
