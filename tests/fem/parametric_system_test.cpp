#include "fem/parametric_system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/exact/exact_cantilever.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::fem::parametric_system_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Quantity = BeamParameter::Quantity;

// d omega_i^2 / dp_j = phi^T (K_j - omega^2 M_j) phi [fox1968].
double square_slope(const ParametricSystem& system, const Modes& modes, Index i, std::size_t j) {
  const VectorXd shape = modes.shape.col(i), strains = system.strain * shape;
  const double square = modes.angular_frequency[i] * modes.angular_frequency[i];
  return strains.dot(system.derivatives[j].rigidity * strains) -
         square * shape.dot(system.derivatives[j].mass * shape);
}

// A beam that has one of everything: Timoshenko, tapered at its end, damaged, loaded, on an elastic root.
Beam rich_beam(double axial_load) {
  Beam beam = test::steel_beam(0.36);
  Section sheared = beam.segments[0].section;
  sheared.shear_stiffness = 3e5;
  sheared.rotary_inertia = 0.01;
  Section tapered = beam.segments[0].section;
  tapered.bending_stiffness = Variation::linear(228.0, 120.0);
  beam.segments = {{0.5, sheared}, {0.6, tapered}};
  beam.bodies = {{beam.length(), 0.3, 2e-3, 0.01}, {beam.length(), 0.06, 0.0, 0.0}};
  beam.supports = {};
  beam.springs = {{0.0, 3e5, 4e3, 0.0}, {0.7, 100.0, 2.0, 0.0}};
  beam.damages = {{0.2, 0.35, 0.2}};
  beam.absorbers = {{0.9, 0.1, 60.0, 0.3}};
  beam.axial_load = axial_load;
  return beam;
}

const std::vector<BeamParameter> everything{{Quantity::bending_stiffness, std::pair{0.25, 0.6}},
                                            {Quantity::bending_stiffness, std::pair{0.8, 1.1}},
                                            {Quantity::tip_mass, {}},
                                            {Quantity::tip_rotary_inertia, {}},
                                            {Quantity::root_rotational_stiffness, {}},
                                            {Quantity::root_translational_stiffness, {}},
                                            {Quantity::axial_load, {}}};

std::string refusal(const Beam& beam, const std::vector<BeamParameter>& parameters) {
  try {
    assemble_parametric(beam, 8, {natural_point(beam)}, parameters);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(ParametricSystem, IsTheBeamItselfAtItsOwnValues) {
  // Oracle: assemble() on a beam with the same nodes.
  const Beam beam = rich_beam(12.0);
  const auto system = assemble_parametric(beam, 12, {natural_point(beam)}, everything);
  const auto plain = assemble(with_nodes(beam, {0.25, 0.6, 0.8}), 12, {natural_point(beam)});
  EXPECT_EQ((MatrixXd(system.system.mass) - MatrixXd(plain.mass)).norm(), 0.0);
  EXPECT_EQ((system.system.stiffness.assembled() - plain.stiffness.assembled()).norm(), 0.0);
}

TEST(ParametricSystem, IsAffineInEveryParameter) {
  // Oracle: the beam with other values, assembled anew, all values changed together and far.
  for (const double load : {0.0, 12.0}) {
    const Beam beam = rich_beam(load);
    const auto system = assemble_parametric(beam, 12, {natural_point(beam)}, everything);
    const double factors[] = {0.4, 1.7, 3.0, 0.2, 0.1, 5.0, 0.0};
    Beam other = beam;
    MatrixXd mass = MatrixXd(system.system.mass), inputs = MatrixXd(system.system.inputs);
    MatrixXd stiffness = MatrixXd(system.system.stiffness.assembled());
    for (std::size_t j = 0; j < everything.size(); ++j) {
      const double value = system.values[static_cast<Index>(j)];
      const double changed = everything[j].quantity == Quantity::axial_load ? -25.0 : factors[j] * value;
      other = with_value(other, everything[j], changed);
      EXPECT_NEAR(value_of(other, everything[j]), changed, 1e-12 * std::abs(changed));
      mass += (changed - value) * MatrixXd(system.derivatives[j].mass);
      inputs += (changed - value) * MatrixXd(system.derivatives[j].inputs);
      stiffness += (changed - value) * MatrixXd(system.stiffness_derivative(j));
    }
    const auto anew = assemble(other, 12, {natural_point(beam)});
    ASSERT_EQ(anew.size(), system.system.size());
    EXPECT_LT((MatrixXd(anew.mass) - mass).norm(), 1e-13 * mass.norm());
    EXPECT_LT((MatrixXd(anew.inputs) - inputs).norm(), 1e-13 * inputs.norm());
    EXPECT_LT((MatrixXd(anew.stiffness.assembled()) - stiffness).norm(), 1e-13 * stiffness.norm());
  }
}

TEST(ParametricSystem, GivesTheDerivativesOfFrequencies) {
  // Oracle: central differences of the frequencies of beams assembled anew; they are good to about 1e-9.
  const Beam beam = rich_beam(12.0);
  const auto system = assemble_parametric(beam, 16, {natural_point(beam)}, everything);
  const Modes found = modes(system.system, 4);
  for (std::size_t j = 0; j < everything.size(); ++j) {
    const double value = system.values[static_cast<Index>(j)], step = 1e-4 * value;
    const auto squares = [&](double at) {
      const Beam other = with_nodes(with_value(beam, everything[j], at), {0.25, 0.6, 0.8});
      return VectorXd(modes(assemble(other, 16, {natural_point(beam)}), 4).angular_frequency.cwiseAbs2());
    };
    const VectorXd difference = (squares(value + step) - squares(value - step)) / (2.0 * step);
    for (Index i = 0; i < 4; ++i) {
      const double scale = found.angular_frequency[i] * found.angular_frequency[i] / value;
      EXPECT_NEAR(square_slope(system, found, i, j), difference[i], 1e-7 * scale) << i << " " << j;
    }
  }
}

TEST(ParametricSystem, StiffnessMovesTheSquaredFrequencyInProportion) {
  // Oracle: omega^2 is proportional to E I, hence d omega^2 / dEI = omega^2 / EI, of every mode.
  const Cantilever beam = test::steel_beam(0.0198575);
  const auto system =
      assemble_parametric(beam, 40, {{"tip", 1.10}}, {{Quantity::bending_stiffness, std::nullopt}});
  const Modes found = modes(system.system, 6);
  for (Index i = 0; i < 6; ++i) {
    const double exact = found.angular_frequency[i] * found.angular_frequency[i] / beam.bending_stiffness;
    EXPECT_NEAR(square_slope(system, found, i, 0), exact, 1e-11 * exact);
  }
}

TEST(ParametricSystem, TipMassMovesFrequenciesAsInTheExactCantilever) {
  // Oracle: d omega^2 / dM = -omega^2 / (mass at the tip) of the exact mode (Rayleigh's quotient); forty
  // elements are exact to 1e-6 there.
  for (const auto& known : test::five_beams) {
    const Cantilever beam = test::steel_beam(known.tip_mass);
    const auto system = assemble_parametric(beam, 40, {{"tip", 1.10}}, {{Quantity::tip_mass, std::nullopt}});
    const Modes found = modes(system.system, 3);
    for (int i = 0; i < 3; ++i) {
      const ExactMode exact(beam, i + 1);
      const double slope = -std::pow(exact.angular_frequency(), 2) / exact.mass_at_tip();
      EXPECT_NEAR(square_slope(system, found, i, 0), slope, 1e-5 * std::abs(slope));
    }
  }
}

TEST(ParametricSystem, RegionsAddUpToTheWholeBeam) {
  // Oracle: with E I the same everywhere, dK/dEI of the whole is the sum of the regions'.
  const Cantilever beam = test::steel_beam(0.36);
  std::vector<BeamParameter> parameters;
  const double ends[] = {0.0, 0.13, 0.4, 0.77, 1.10};
  for (int i = 0; i < 4; ++i)
    parameters.push_back({Quantity::bending_stiffness, std::pair{ends[i], ends[i + 1]}});
  parameters.push_back({Quantity::bending_stiffness, std::nullopt});
  const auto system = assemble_parametric(beam, 20, {{"tip", 1.10}}, parameters);
  SparseMatrix sum = system.derivatives[0].rigidity;
  for (std::size_t j = 1; j < 4; ++j) sum += system.derivatives[j].rigidity;
  EXPECT_LT((sum - system.derivatives[4].rigidity).norm(), 1e-14 * sum.norm());
}

TEST(ParametricSystem, KnowsTheMeanStiffnessOfWhatIsDamagedAndTapered) {
  // Oracle: by hand. Half of the region has lost a fifth; the mean of a straight taper is that of its ends.
  Beam beam = test::steel_beam(0.0);
  const double whole = beam.segments[0].section.bending_stiffness(0.0);
  beam.damages = {{0.2, 0.4, 0.2}};
  EXPECT_NEAR(value_of(beam, {Quantity::bending_stiffness, std::pair{0.3, 0.5}}), 0.9 * whole, 1e-12 * whole);
  beam.damages = {};
  beam.segments[0].section.bending_stiffness = Variation::linear(200.0, 90.0);
  EXPECT_NEAR(value_of(beam, {Quantity::bending_stiffness, std::nullopt}), 145.0, 1e-11);
  EXPECT_NEAR(value_of(beam, {Quantity::bending_stiffness, std::pair{0.55, 1.10}}), 117.5, 1e-11);
}

TEST(ParametricSystem, RefusesWhatTheBeamDoesNotHave) {
  const Beam beam = test::steel_beam(0.36);
  EXPECT_THAT(refusal(beam, {{Quantity::root_rotational_stiffness, {}}}),
              testing::HasSubstr("no elastic root"));
  EXPECT_THAT(refusal(beam, {{Quantity::bending_stiffness, std::pair{0.5, 1.2}}}),
              testing::AllOf(testing::HasSubstr("0.5 to 1.2 m"), testing::HasSubstr("1.1 m")));
  EXPECT_THAT(refusal(beam, {{Quantity::tip_mass, std::pair{0.5, 0.6}}}), testing::HasSubstr("regions"));
  Beam held = beam;
  held.supports = {{0.0, true, true}, {1.10, true, true}};
  EXPECT_THAT(refusal(held, {{Quantity::tip_mass, {}}}), testing::HasSubstr("has no effect"));
  EXPECT_THROW(with_value(beam, {Quantity::tip_mass, {}}, -1.0), std::invalid_argument);
  EXPECT_THROW(with_value(beam, {Quantity::bending_stiffness, {}}, 0.0), std::invalid_argument);
}

TEST(Variation, PartsArePiecesOfTheWhole) {
  // Oracle: the whole, at the same places.
  const Variation slope = Variation::linear(2.0, 0.5);
  const Variation whole = slope * slope * Variation::linear(0.3, 4.0), piece = whole.part(0.25, 0.7);
  for (const double s : {0.0, 0.2, 0.55, 1.0}) EXPECT_NEAR(piece(s), whole(0.25 + 0.45 * s), 1e-14);
}

// Exact curvature of a mode of a uniform cantilever: beta^2 W'' / W of the differential equation, at the
// root.
double root_curvature(const ExactMode& mode, double length) {
  // w'' at the root from the equation of its static reaction: w(x) = a x^2 / 2 + b x^3 / 6 + O(x^6) there.
  const double x = 1e-3 * length, y = 2e-3 * length;
  const double f = 2.0 * mode.shape(x) / (x * x), g = 2.0 * mode.shape(y) / (y * y);
  return 2.0 * f - g;
}

TEST(CurvatureRow, ErrsByTheFourthPowerOfTheElementLengthAtAClampedRoot) {
  // Oracle: the exact cantilever; its w'' at the root, extrapolated from w near it, is good to 1e-8.
  const Cantilever beam = test::steel_beam(0.36);
  for (const int mode : {1, 2, 3}) {
    const double exact = root_curvature(ExactMode(beam, mode), beam.length);
    double before = 0.0;
    for (const int elements : {40, 80}) {
      const auto system = assemble(beam, elements);
      const Modes found = modes(system, mode);
      const VectorXd shape = found.shape.col(mode - 1);
      const VectorXd read = curvature_row(system, 0.0) * shape;
      const double error = std::abs(read[0] / (system.outputs * shape)[0] / exact - 1.0);
      if (elements == 40) {
        EXPECT_LT(error, mode == 1 ? 1e-6 : mode == 2 ? 3e-5 : 3e-4);
      } else if (mode > 1) {
        EXPECT_GT(before / error, 12.0) << mode;
      }
      before = error;
    }
  }
}

TEST(CurvatureRow, IsExactUnderAStaticTipForce) {
  // Oracle: w'' = F (L - x) / EI, on both sides of a step of E I their mean; also with shear deformation.
  Beam beam = test::steel_beam(0.0);
  const double stiffness = beam.segments[0].section.bending_stiffness(0.0);
  beam.segments[0].section.shear_stiffness = 2e4;
  beam.damages = {{0.4, 0.6, 0.5}};
  const auto system = assemble(beam, 11);
  const VectorXd q = StiffnessSolver(system.stiffness).solve(MatrixXd(system.inputs.col(0)));
  for (const double x : {0.0, 0.1, 0.6, 1.1}) {
    const double mean = x == 0.6 ? 0.5 * (1.0 + 2.0) : 1.0;
    EXPECT_NEAR((curvature_row(system, x) * q)[0], mean * (1.1 - x) / stiffness, 1e-11 / stiffness) << x;
  }
}

TEST(CurvatureRow, RefusesAPlaceWithoutANode) {
  EXPECT_THROW(curvature_row(assemble(test::steel_beam(0.0), 10), 0.123), std::invalid_argument);
  EXPECT_THROW(curvature_row(StructuralSystem{}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::fem::parametric_system_test
