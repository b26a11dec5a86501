// How fast the frequencies of the finite elements approach the exact ones.
#include <numbers>

#include "tests/fem/verification/oracle.hpp"

namespace beamid::convergence_test {
namespace {

using test::length;

double error(const fem::Beam& beam, int elements, int mode) {
  return fem::modes(fem::assemble(beam, elements, {}), mode).angular_frequency[mode - 1] /
             fem::exact_modes(beam, mode, {})->angular_frequency[mode - 1] -
         1.0;
}

double order(const fem::Beam& beam, int mode, int elements = 30) {
  return std::log2(error(beam, elements, mode) / error(beam, 2 * elements, mode));
}

TEST(Convergence, ErrorIsBhOverLToTheFourthOver1440) {
  // Oracle: the energy that a uniform inertia force leaves in an element whose ends are held, which Hermite's
  // cubics cannot follow: a beam of length h clamped at both ends stores q^2 h^5 / 1440 EI under q = omega^2
  // rho A w. Over the kinetic energy, omega^2 rho A w^2 / 2 per length, that is (beta h)^4 / 720: omega^2 is
  // too high by it, omega by half of it, b = beta L being the root of this mode, whatever the supports.
  const struct {
    std::vector<fem::Support> supports;
    int first;  // elastic mode, counted with the rigid ones
  } beams[] = {{{{0.0, true, true}}, 1},
               {{{0.0, true, true}, {length, true, true}}, 1},
               {{{0.0, true, true}, {length, true, false}}, 1},
               {{{0.0, true, false}, {length, true, false}}, 1},
               {{{0.0, true, true}, {length, false, true}}, 1},
               {{}, 3},
               {{{0.0, true, false}}, 2}};
  for (std::size_t k = 0; k < std::size(beams); ++k) {
    fem::Beam beam = test::uniform_beam();
    beam.supports = beams[k].supports;
    for (int mode = beams[k].first; mode < beams[k].first + 4; ++mode) {
      const double omega = fem::exact_modes(beam, mode, {})->angular_frequency[mode - 1];
      const double b = std::sqrt(omega / test::angular_frequency(1.0));
      const int elements = 40;
      EXPECT_NEAR(error(beam, elements, mode) / (std::pow(b / elements, 4) / 1440.0), 1.0, 0.05)
          << "beam " << k << ", mode " << mode;
      EXPECT_NEAR(order(beam, mode), 4.0, 0.06) << "beam " << k << ", mode " << mode;
    }
  }
}

fem::Beam cantilever() {
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}};
  return beam;
}

TEST(Convergence, OrderFourWithRotaryInertia) {
  fem::Beam beam = cantilever();
  beam.segments[0].section.rotary_inertia = 0.007;
  for (int mode = 1; mode <= 3; ++mode) EXPECT_NEAR(order(beam, mode), 4.0, 0.06) << mode;
}

TEST(Convergence, OrderFourUnderAxialLoad) {
  for (const double load : {2.0, -20.0}) {
    fem::Beam beam = cantilever();
    beam.axial_load = load;
    for (int mode = 1; mode <= 3; ++mode) EXPECT_NEAR(order(beam, mode), 4.0, 0.06) << load << ", " << mode;
  }
}

TEST(Convergence, OrderFourWithTaper) {
  // Oracle: the difference of successive meshes; no exact frequency is needed for the order.
  fem::Beam beam = cantilever();
  beam.segments[0].section.bending_stiffness = fem::Variation::linear(7.3, 1.1);
  beam.segments[0].section.mass_per_length = fem::Variation::linear(0.9, 0.3);
  for (int mode = 1; mode <= 3; ++mode) {
    double omega[3];
    for (int k = 0; k < 3; ++k)
      omega[k] = fem::modes(fem::assemble(beam, 20 << k, {}), mode).angular_frequency[mode - 1];
    EXPECT_NEAR(std::log2((omega[0] - omega[1]) / (omega[1] - omega[2])), 4.0, 0.1) << mode;
  }
}

TEST(Convergence, OrderTwoWithLumpedMass) {
  fem::Beam beam = cantilever();
  beam.mass_model = fem::MassModel::lumped;
  for (int mode = 1; mode <= 3; ++mode) {
    EXPECT_NEAR(order(beam, mode), 2.0, 0.05) << mode;
    EXPECT_LT(error(beam, 40, mode), 0.0) << "lumped masses vibrate too slowly, mode " << mode;
  }
}

TEST(Convergence, OrderFourWithShear) {
  // An element without interior coordinates would converge with order two: its static shapes miss the shear
  // that inertia forces cause inside it.
  for (const double load : {0.0, 2.0}) {
    fem::Beam beam = cantilever();
    beam.segments[0].section.rotary_inertia = 0.007;
    beam.segments[0].section.shear_stiffness = 900.0;
    beam.axial_load = load;
    for (int mode = 1; mode <= 3; ++mode) EXPECT_NEAR(order(beam, mode, 10), 4.0, 0.1) << mode;
  }
}

TEST(Convergence, OrderFourWithShearAndTaper) {
  // Oracle: the difference of successive meshes.
  fem::Beam beam = cantilever();
  beam.segments[0].section.bending_stiffness = fem::Variation::linear(7.3, 1.1);
  beam.segments[0].section.mass_per_length = fem::Variation::linear(0.9, 0.3);
  beam.segments[0].section.shear_stiffness = fem::Variation::linear(900.0, 300.0);
  beam.segments[0].section.rotary_inertia = fem::Variation::linear(0.007, 0.001);
  for (int mode = 1; mode <= 3; ++mode) {
    double omega[3];
    for (int k = 0; k < 3; ++k)
      omega[k] = fem::modes(fem::assemble(beam, 20 << k, {}), mode).angular_frequency[mode - 1];
    EXPECT_NEAR(std::log2((omega[0] - omega[1]) / (omega[1] - omega[2])), 4.0, 0.15) << mode;
  }
}

TEST(Convergence, NearlySharpTipsConvergeFromAboveToo) {
  // Oracle: the sharp cone's exact 8.719 (taper_test.cpp), which a tip a thousandth as thick as the root is
  // near; shapes that are not those of the section would find a soft tip that is not there.
  const auto height = fem::Variation::linear(1.0, 1e-3);
  fem::Beam beam = cantilever();
  beam.segments = {{1.0, {height * height * height * height, height * height, 0.0, {}, {}, {}}}};
  double last = 1e9;
  for (const int elements : {5, 10, 20, 40, 80}) {
    const double omega = fem::modes(fem::assemble(beam, elements, {}), 1).angular_frequency[0];
    EXPECT_LT(omega, last) << elements;
    EXPECT_NEAR(omega / 8.719, 1.0, 0.05) << elements;
    last = omega;
  }
}

TEST(Convergence, ShapesConvergeWithTheFrequencies) {
  // Oracle: exact_modes at the nodes; the nodal values of a mode are as good as its frequency.
  fem::Beam beam = cantilever();
  beam.bodies = {{length, 0.5, 0.01, 0.1}};
  const auto difference = [&](int elements) {
    const auto system = fem::assemble(beam, elements, {});
    const auto modes = fem::modes(system, 3);
    const auto exact = fem::exact_modes(beam, 3, system.mesh.positions());
    Eigen::VectorXd w = fem::nodal_deflection(system, modes.shape.col(2));
    Eigen::Index largest = 0;
    exact->deflection.col(2).cwiseAbs().maxCoeff(&largest);
    w /= double{w[largest]};
    return (w - exact->deflection.col(2)).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(difference(80), 1e-6);
  EXPECT_NEAR(std::log2(difference(40) / difference(80)), 4.0, 0.2);
}

}  // namespace
}  // namespace beamid::convergence_test
