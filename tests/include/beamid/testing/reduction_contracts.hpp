// Conformance of reductions: each keeps the contracts that it declares (reduction/reduction.hpp), and what
// all share. To be included by one file of a test program, which says what it runs on, in namespace
// beamid::test:
//
//     INSTANTIATE_TEST_SUITE_P(Mine, EveryReduction, testing::Values("my_reduction"), by_name);
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "beamid/testing/named.hpp"
#include "beamid/testing/steel_beam.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "reduction/reduction.hpp"

namespace beamid::test {

/// The suite, on a registered name.
class EveryReduction : public testing::TestWithParam<std::string> {
 protected:
  fem::StructuralSystem system = fem::assemble(steel_beam(0.36049), 20);
  std::unique_ptr<reduction::Reduction> method = reduction::reduction_registry().make(GetParam(), {});

  static bool declares(const char* contract) {
    return reduction::reduction_registry().find(GetParam()).contracts.contains(contract);
  }
};

namespace reduction_contracts {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using reduction::reduction_registry;

/// The option by which a method grows.
inline std::string size_option(const std::string& name) {
  for (const filters::OptionSpec& option : reduction_registry().find(name).options)
    if (option.name == "modes" || option.name == "moments") return option.name;
  return "";
}

inline fem::Beam free_beam() {
  fem::Beam beam = steel_beam(0.36049);
  beam.supports.clear();
  return beam;
}

TEST_P(EveryReduction, ProjectsTheSameEquations) {
  // Oracle: Phi^T (.) Phi of the assembled matrices, formed here a second way.
  const auto model = reduce(system, *method);
  const MatrixXd shapes = model.dense_shapes();
  const MatrixXd stiffness = shapes.transpose() * (system.stiffness.assembled() * shapes);
  const MatrixXd mass = shapes.transpose() * (system.mass * shapes);
  EXPECT_LT((MatrixXd(model.system.stiffness.assembled()) - stiffness).norm(), 1e-8 * stiffness.norm());
  EXPECT_LT((MatrixXd(model.system.mass) - mass).norm(), 1e-13 * mass.norm());
  const VectorXd z = VectorXd::LinSpaced(model.system.size(), 1.0, 2.0);
  EXPECT_LT((model.system.outputs * z - system.outputs * model.lift(z)).norm(), 1e-13 * z.norm());
}

TEST_P(EveryReduction, NeverSoftensAnyMode) {
  // Oracle: Rayleigh's principle, mode i of any assumed shapes is not below mode i of the system.
  const auto model = reduce(system, *method);
  const VectorXd full = fem::modes(system, model.system.size()).angular_frequency,
                 reduced = fem::modes(model.system, model.system.size()).angular_frequency;
  for (Index i = 0; i < reduced.size(); ++i) EXPECT_GE(reduced[i], full[i] * (1.0 - 1e-11)) << i;
}

TEST_P(EveryReduction, NeverSoftensABeamUnderAxialLoad) {
  // Oracle: Rayleigh's principle again, at half the buckling load pi^2 EI / (4 L^2), where no triangular
  // factor of the rigidity exists.
  fem::Beam beam = steel_beam(0.36049);
  beam.axial_load = 0.5 * 2.4674011 * 228.96 / 1.21;
  const fem::StructuralSystem loaded = assemble(beam, 20);
  const double full = fem::modes(loaded, 1).angular_frequency[0];
  EXPECT_LT(full, 0.8 * fem::modes(system, 1).angular_frequency[0]);
  EXPECT_GE(fem::modes(reduce(loaded, *method).system, 1).angular_frequency[0], full * (1.0 - 1e-9));
}

TEST_P(EveryReduction, TreatsAFreeStructureOrSaysWhyNot) {
  // Oracle: two rigid-body motions of a free beam, from above again.
  const fem::StructuralSystem loose = assemble(free_beam(), 20);
  try {
    const auto model = reduce(loose, *method);
    const fem::Modes modes = fem::modes(model.system, model.system.size());
    EXPECT_LE(modes.rigid, 2);
    EXPECT_TRUE(modes.angular_frequency.allFinite());
  } catch (const std::invalid_argument& refusal) {
    EXPECT_NE(std::string(refusal.what()).find(GetParam()), std::string::npos) << refusal.what();
  }
}

TEST_P(EveryReduction, SpansTheLowestModesWhereItSaysSo) {
  // Oracle: modes of the whole system, and what is left of them beside their M-projection on the shapes.
  if (!method->spans_lowest_modes()) GTEST_SKIP();
  const auto model = reduce(system, *method);
  const MatrixXd shapes = model.dense_shapes(), modes = fem::modes(system, shapes.cols()).shape,
                 mass = shapes.transpose() * (system.mass * shapes),
                 left = modes - shapes * mass.ldlt().solve(shapes.transpose() * (system.mass * modes));
  for (Index i = 0; i < left.cols(); ++i)
    EXPECT_LT(std::sqrt(left.col(i).dot(system.mass * left.col(i))), 1e-9) << i;
}

TEST_P(EveryReduction, RejectsUnknownOptions) {
  EXPECT_THROW(reduction_registry().make(GetParam(), {{"no_such_option", 1.0}}), std::invalid_argument);
}

TEST_P(EveryReduction, RejectsSizesThatAreNone) {
  if (size_option(GetParam()).empty()) GTEST_SKIP() << "of one size";
  for (const double size : {-1.0, 1.5, 1e9, std::nan("")})
    EXPECT_THROW(reduction_registry().make(GetParam(), {{size_option(GetParam()), size}}),
                 std::invalid_argument)
        << size;
}

TEST_P(EveryReduction, KeepsTheLowestModesIfItsModesAreExact) {
  if (!declares(reduction::contract::modes_exact)) GTEST_SKIP() << "not promised";
  const auto model = reduce(system, *method);
  const auto full = fem::modes(system, model.system.size()),
             reduced = fem::modes(model.system, model.system.size());
  for (Index i = 0; i < reduced.size(); ++i)
    EXPECT_NEAR(reduced.angular_frequency[i] / full.angular_frequency[i], 1.0, 1e-9);
}

TEST_P(EveryReduction, KeepsTheStaticDeflectionIfItsStaticsAreExact) {
  if (!declares(reduction::contract::static_exact)) GTEST_SKIP() << "not promised";
  EXPECT_NEAR(static_stiffness(reduce(system, *method).system) / static_stiffness(system), 1.0, 1e-10);
}

TEST_P(EveryReduction, KeepsTheRigidMotionsOfAFreeBeamIfItPromisesThem) {
  if (!declares(reduction::contract::rigid_exact)) GTEST_SKIP() << "not promised";
  // Oracle: translation and rotation of a free beam, which its reduced system must lift to, w linear in x.
  const auto loose = assemble(free_beam(), 20, {{"root", 0.0}, {"tip", 1.1}});
  filters::Options options;
  if (size_option(GetParam()) == "modes") options.set("modes", 2.0);
  const auto model = reduce(loose, *reduction_registry().make(GetParam(), options));
  const fem::Modes modes = fem::modes(model.system, 2);
  ASSERT_EQ(modes.rigid, 2);
  for (Index i = 0; i < 2; ++i) {
    const VectorXd w = nodal_deflection(loose, model.lift(modes.shape.col(i))), x = loose.mesh.positions();
    for (Index node = 0; node < w.size(); ++node)
      EXPECT_NEAR(w[node], w[0] + (w[w.size() - 1] - w[0]) * x[node] / 1.1, 1e-9 * w.norm());
  }
}

TEST_P(EveryReduction, GrowsUntilNothingIsReducedIfItGrows) {
  if (!declares(reduction::contract::grows)) GTEST_SKIP() << "not promised";
  // Oracle: all frequencies of the full system.
  const fem::StructuralSystem small = assemble(steel_beam(0.36049), 6);
  const std::string option = size_option(GetParam());
  const filters::Options fallback = reduction_registry().completed(GetParam(), {});
  const Index other_shapes =
      reduce(small, *method).system.size() - static_cast<Index>(fallback.number(option));
  const auto all =
      reduction_registry().make(GetParam(), {{option, static_cast<double>(small.size() - other_shapes)}});
  const auto model = reduce(small, *all);
  ASSERT_EQ(model.system.size(), small.size());
  const fem::Modes full = fem::modes(small, small.size()), same = fem::modes(model.system, small.size());
  for (Index i = 0; i < small.size(); ++i)
    EXPECT_NEAR(same.angular_frequency[i] / full.angular_frequency[i], 1.0, 1e-9) << i;
}

TEST_P(EveryReduction, GrowsNotBeyondTheSystem) {
  if (!declares(reduction::contract::grows)) GTEST_SKIP() << "not promised";
  const auto beyond = reduction_registry().make(GetParam(), {{size_option(GetParam()), 1000.0}});
  try {
    EXPECT_LE(reduce(system, *beyond).system.size(), system.size());
  } catch (const std::invalid_argument& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("1000"), std::string::npos) << refusal.what();
  }
}

TEST_P(EveryReduction, DescribesItselfAndItsOptions) {
  expect_described(reduction_registry().find(GetParam()));
}

}  // namespace reduction_contracts
}  // namespace beamid::test
