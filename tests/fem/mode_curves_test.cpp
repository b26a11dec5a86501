// Oracles: the modes of the beam assembled at other values, and what scaling all stiffness does.
#include "fem/modes.hpp"

#include <gtest/gtest.h>

#include "tests/fem/five_beams.hpp"

namespace beamid::fem::mode_curves_test {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Quantity = BeamParameter::Quantity;

constexpr Index count = 6;

// Clamped elastically, every kind of parameter asked about; heard at the tip and at 0.5 m.
struct Structure {
  Beam beam = [] {
    Beam result = test::steel_beam(0.36);
    result.supports = {};
    result.springs = {{0.0, 3e5, 4e3, 0.0}};
    result.bodies[0].rotary_inertia = 1e-3;
    result.axial_load = -20.0;
    return result;
  }();
  std::vector<BeamParameter> parameters{{Quantity::bending_stiffness, std::pair{0.0, 0.3}},
                                        {Quantity::bending_stiffness, std::pair{0.3, 1.1}},
                                        {Quantity::tip_mass, {}},
                                        {Quantity::tip_rotary_inertia, {}},
                                        {Quantity::root_rotational_stiffness, {}},
                                        {Quantity::axial_load, {}}};

  ParametricSystem at(const VectorXd& values) const {
    Beam moved = beam;
    for (std::size_t j = 0; j < parameters.size(); ++j)
      moved = with_value(moved, parameters[j], values[static_cast<Index>(j)]);
    return assemble_parametric(moved, 20, {natural_point(moved), {"middle", 0.5}}, parameters);
  }
  VectorXd values() const { return assemble_parametric(beam, 20, {natural_point(beam)}, parameters).values; }
};

// The largest errors of omega^2 (relative) and of the readings (of the largest) at p_0 + step.
std::pair<double, double> errors(const Structure& structure, const std::vector<ModeCurve>& curves,
                                 const VectorXd& step) {
  const ParametricSystem there = structure.at(structure.values() + step);
  const Modes modes = fem::modes(there.system, count);
  double of_square = 0.0, of_reading = 0.0;
  for (Index i = 0; i < count; ++i) {
    const ModeCurve& curve = curves[static_cast<std::size_t>(i)];
    const double truth = modes.angular_frequency[i] * modes.angular_frequency[i];
    const double found =
        curve.square + step.dot(curve.square_slope) + 0.5 * step.dot(curve.square_curvature * step);
    of_square = std::max(of_square, std::abs(found / truth - 1.0));
    VectorXd reading = there.system.outputs * modes.shape.col(i), followed = curve.reading;
    for (Index k = 0; k < reading.size(); ++k)
      followed[k] += curve.reading_slope.row(k).dot(step) +
                     0.5 * step.dot(curve.reading_curvature[static_cast<std::size_t>(k)] * step);
    if (reading.dot(followed) < 0.0) reading *= -1.0;
    of_reading = std::max(of_reading,
                          (followed - reading).lpNorm<Eigen::Infinity>() / reading.lpNorm<Eigen::Infinity>());
  }
  return {of_square, of_reading};
}

TEST(ModeCurves, AreRightToTheSecondOrder) {
  const Structure structure;
  const VectorXd values = structure.values();
  const ParametricSystem equations = structure.at(values);
  const std::vector<ModeCurve> curves = mode_curves(equations, modes(equations.system, count));
  VectorXd direction(values.size());
  direction << 1.0, -0.8, 0.6, 1.0, -1.0, 0.7;
  direction = direction.cwiseProduct(values.cwiseAbs());
  const auto [square, reading] = errors(structure, curves, 0.04 * direction);
  const auto [square_half, reading_half] = errors(structure, curves, 0.02 * direction);
  // Errors of the third order shrink eightfold.
  EXPECT_NEAR(square / square_half, 8.0, 0.8);
  EXPECT_NEAR(reading / reading_half, 8.0, 0.8);
  EXPECT_LT(square_half, 1e-5);
  EXPECT_LT(reading_half, 1e-4);
}

TEST(ModeCurves, OfAllStiffnessMoveFrequenciesOnly) {
  const Beam beam = test::steel_beam(0.36);
  const ParametricSystem equations =
      assemble_parametric(beam, 40, {natural_point(beam)}, {{Quantity::bending_stiffness, {}}});
  for (const ModeCurve& curve : mode_curves(equations, modes(equations.system, count))) {
    EXPECT_NEAR(curve.square_slope[0] * equations.values[0] / curve.square, 1.0, 1e-9);
    EXPECT_LT(std::abs(curve.square_curvature(0, 0)) * std::pow(equations.values[0], 2) / curve.square, 1e-6);
    EXPECT_LT(std::abs(curve.reading_slope(0, 0)) * equations.values[0] / std::abs(curve.reading[0]), 1e-6);
  }
}

TEST(ModeCurves, AreRefusedForAStructureThatIsNotHeld) {
  Beam beam = test::steel_beam(0.36);
  beam.supports = {};
  const ParametricSystem equations =
      assemble_parametric(beam, 10, {natural_point(beam)}, {{Quantity::bending_stiffness, {}}});
  EXPECT_THROW(mode_curves(equations, modes(equations.system, 4)), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::fem::mode_curves_test
