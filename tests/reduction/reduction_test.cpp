// Conformance: every registered reduction keeps the promises it declares. A new one is found by itself.
#include "reduction/reduction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::reduction_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using reduction::reduction_registry;

// The option by which a method grows.
std::string size_option(const std::string& name) {
  for (const filters::OptionSpec& option : reduction_registry().find(name).options)
    if (option.name == "modes" || option.name == "moments") return option.name;
  return "";
}

fem::Beam free_beam() {
  fem::Beam beam = test::steel_beam(0.36049);
  beam.supports.clear();
  return beam;
}

class EveryReduction : public testing::TestWithParam<std::string> {
 protected:
  fem::StructuralSystem system = assemble(test::steel_beam(0.36049), 20);
  std::unique_ptr<reduction::Reduction> method = reduction_registry().make(GetParam(), {});
};

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
  fem::Beam beam = test::steel_beam(0.36049);
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

class EverySizedReduction : public EveryReduction {};
TEST_P(EverySizedReduction, RejectsSizesThatAreNone) {
  for (const double size : {-1.0, 1.5, 1e9, std::nan("")})
    EXPECT_THROW(reduction_registry().make(GetParam(), {{size_option(GetParam()), size}}),
                 std::invalid_argument)
        << size;
}
std::vector<std::string> sized_names() {
  std::vector<std::string> result = names();
  std::erase_if(result, [](const std::string& name) { return size_option(name).empty(); });
  return result;
}
INSTANTIATE_TEST_SUITE_P(Registered, EverySizedReduction, testing::ValuesIn(sized_names()), by_name);

class PromisesExactModes : public EveryReduction {};
TEST_P(PromisesExactModes, KeepsTheLowestModes) {
  const auto model = reduce(system, *method);
  const auto full = fem::modes(system, model.system.size()),
             reduced = fem::modes(model.system, model.system.size());
  for (Index i = 0; i < reduced.size(); ++i)
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

class PromisesRigidMotions : public EveryReduction {};
TEST_P(PromisesRigidMotions, KeepsThoseOfAFreeBeam) {
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
INSTANTIATE_TEST_SUITE_P(Registered, PromisesRigidMotions,
                         testing::ValuesIn(names(reduction::contract::rigid_exact)), by_name);

class PromisesToGrow : public EveryReduction {};
TEST_P(PromisesToGrow, UntilNothingIsReduced) {
  // Oracle: all frequencies of the full system.
  const fem::StructuralSystem small = assemble(test::steel_beam(0.36049), 6);
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
TEST_P(PromisesToGrow, AndNotBeyond) {
  const auto beyond = reduction_registry().make(GetParam(), {{size_option(GetParam()), 1000.0}});
  try {
    EXPECT_LE(reduce(system, *beyond).system.size(), system.size());
  } catch (const std::invalid_argument& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("1000"), std::string::npos) << refusal.what();
  }
}
INSTANTIATE_TEST_SUITE_P(Registered, PromisesToGrow, testing::ValuesIn(names(reduction::contract::grows)),
                         by_name);

TEST(Registry, NamesWhatItKnows) {
  try {
    reduction_registry().make("guian", {});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "unknown reduction 'guian'; known: balanced_truncation, craig_bampton, guyan, irs, krylov, "
                 "modal_truncation, none, pod, rayleigh, serep");
  }
}

}  // namespace
}  // namespace beamid::reduction_test
