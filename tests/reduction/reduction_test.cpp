// Conformance: every registered reduction keeps the promises it declares. A new one is found by itself.
#include "reduction/reduction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/assembly.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using reduction::reduction_registry;

class EveryReduction : public testing::TestWithParam<std::string> {
 protected:
  fem::StructuralSystem system = assemble(test::steel_beam(0.36049), 20);
  std::unique_ptr<reduction::Reduction> method = reduction_registry().make(GetParam(), {});
};

TEST_P(EveryReduction, ProjectsTheSameEquations) {
  // Oracle: Phi^T (.) Phi of the assembled matrices, formed here a second way.
  const auto model = reduce(system, *method);
  const MatrixXd stiffness = model.shapes.transpose() * (system.stiffness.assembled() * model.shapes);
  const MatrixXd mass = model.shapes.transpose() * (system.mass * model.shapes);
  EXPECT_LT((MatrixXd(model.system.stiffness.assembled()) - stiffness).norm(), 1e-8 * stiffness.norm());
  EXPECT_LT((MatrixXd(model.system.mass) - mass).norm(), 1e-13 * mass.norm());
  const VectorXd z = VectorXd::LinSpaced(model.system.size(), 1.0, 2.0);
  EXPECT_LT((model.system.outputs * z - system.outputs * model.lift(z)).norm(), 1e-13 * z.norm());
}

TEST_P(EveryReduction, NeverSoftensTheFirstMode) {
  // Oracle: Rayleigh's principle, any assumed shape gives a frequency from above.
  const double full = fem::modes(system, 1).angular_frequency[0];
  const double reduced = fem::modes(reduce(system, *method).system, 1).angular_frequency[0];
  EXPECT_GE(reduced, full * (1.0 - 1e-12));
}

TEST_P(EveryReduction, RejectsUnknownOptions) {
  EXPECT_THROW(reduction_registry().make(GetParam(), {{"no_such_option", 1.0}}), std::invalid_argument);
}

// Names of the registered reductions, or of those that make a promise.
std::vector<std::string> names(const std::string& promise = "") {
  std::vector<std::string> result;
  for (const auto& [name, entry] : reduction_registry().entries())
    if (promise.empty() || entry.contracts.contains(promise)) result.push_back(name);
  return result;
}
const auto by_name = [](const testing::TestParamInfo<std::string>& tested) { return tested.param; };
INSTANTIATE_TEST_SUITE_P(Registered, EveryReduction, testing::ValuesIn(names()), by_name);

class PromisesExactModes : public EveryReduction {};
TEST_P(PromisesExactModes, KeepsTheLowestModes) {
  const auto model = reduce(system, *method);
  const auto full = fem::modes(system, model.system.size()),
             reduced = fem::modes(model.system, model.system.size());
  for (Eigen::Index i = 0; i < reduced.size(); ++i)
    EXPECT_NEAR(reduced.angular_frequency[i] / full.angular_frequency[i], 1.0, 1e-9);
}
INSTANTIATE_TEST_SUITE_P(Registered, PromisesExactModes,
                         testing::ValuesIn(names(reduction::contract::modes_exact)), by_name);

class PromisesExactStatics : public EveryReduction {};
TEST_P(PromisesExactStatics, KeepsTheStaticDeflection) {
  EXPECT_NEAR(static_stiffness(reduce(system, *method).system) / static_stiffness(system), 1.0, 1e-10);
}
INSTANTIATE_TEST_SUITE_P(Registered, PromisesExactStatics,
                         testing::ValuesIn(names(reduction::contract::static_exact)), by_name);

TEST(Rayleigh, EquivalentMassIs33Over140OnAnyMesh) {
  // Oracle: integral of ((3 L x^2 - x^3) / 2 L^3)^2 over the beam = 33/140 L, by hand.
  const fem::Cantilever beam = test::steel_beam(0.36049);
  for (const int elements : {1, 2, 13, 80}) {
    const auto model = reduce(assemble(beam, elements), *reduction_registry().make("rayleigh", {}));
    EXPECT_NEAR(model.system.mass.coeff(0, 0), 33.0 / 140.0 * beam.mass() + beam.tip_mass, 1e-10);
    EXPECT_NEAR(static_stiffness(model.system) / beam.tip_stiffness(), 1.0, 1e-10);
  }
}

TEST(Rayleigh, OneMinusCosineHasItsOwnMassAndStiffness) {
  // Oracle: integrals of (1 - cos)^2 and of the curvature squared, by hand: (3/2 - 4/pi) m and pi^4 EI / 32
  // L^3.
  using std::numbers::pi;
  const fem::Cantilever beam = test::steel_beam(0.0);
  const auto method = reduction_registry().make("rayleigh", {{"shape", "one_minus_cosine"}});
  const auto model = reduce(assemble(beam, 80), *method);
  EXPECT_NEAR(model.system.mass.coeff(0, 0) / ((1.5 - 4.0 / pi) * beam.mass()), 1.0, 1e-8);
  EXPECT_NEAR(static_stiffness(model.system) / (std::pow(pi, 4) / 96.0 * beam.tip_stiffness()), 1.0, 1e-8);
}

TEST(Rayleigh, FrequencyErrorsOfTheFiveBeamsAreTheTabulatedOnes) {
  // Oracle: table of the study, computed outside this project: error of f1 in per cent.
  const double static_shape_error[] = {1.38833, 0.65267, 0.17907, 0.08120, 0.03957};
  const double cosine_error[] = {4.07, 2.70, 1.59, 1.27, 1.09};
  for (int i = 0; i < 5; ++i) {
    const fem::Cantilever beam = test::steel_beam(test::five_beams[i].tip_mass);
    const double exact = fem::ExactMode(beam, 1).angular_frequency();
    const auto error = [&](const char* shape) {
      const auto model =
          reduce(assemble(beam, 40), *reduction_registry().make("rayleigh", {{"shape", std::string(shape)}}));
      return 100.0 * (fem::modes(model.system, 1).angular_frequency[0] / exact - 1.0);
    };
    EXPECT_NEAR(error("static_tip_load"), static_shape_error[i], 5e-6);
    EXPECT_NEAR(error("one_minus_cosine"), cosine_error[i], 5e-3);
  }
}

TEST(ModalTruncation, OneModeHasTheTrueModalMassAtTheTip) {
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

TEST(Registry, NamesWhatItKnows) {
  try {
    reduction_registry().make("guian", {});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "unknown reduction 'guian'; known: modal_truncation, none, rayleigh");
  }
}

TEST(Projection, RefusesDependentShapes) {
  const auto system = assemble(test::steel_beam(0.0), 3);
  MatrixXd twice(6, 2);
  twice << static_shape(system), 2.0 * static_shape(system);
  EXPECT_THROW(reduction::project(system, {twice}), std::invalid_argument);
  EXPECT_THROW(reduction::project(system, {MatrixXd::Identity(5, 2)}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid
