#include "fem/free_decay.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::free_decay_test {
namespace {

TEST(Release, ModalAmplitudesAreThoseOfTheExactContinuum) {
  // Oracle: the table of exact release amplitudes (five_beams.hpp).
  for (const auto& known : test::five_beams) {
    const auto system = assemble(test::steel_beam(known.tip_mass), 80);
    const auto modes = fem::modes(system, 5);
    const Eigen::VectorXd amplitude = modal_amplitudes(system, modes, 0.012 * static_shape(system));
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(1e3 * amplitude[i], known.amplitude_mm[i], (i == 0 ? 5e-5 : i == 1 ? 5e-6 : 5e-7));
  }
}

TEST(FreeDecay, SatisfiesTheEquationOfMotionFromRest) {
  // Oracle: the differential equation itself, x'' + 2 xi w x' + w^2 x = 0, x(0) = a, x'(0) = 0.
  const double omega = 13.1, xi = 0.1;
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(200, 0.0, 2.0);
  const auto one = [](double value) { return Eigen::VectorXd::Constant(1, value); };
  const auto motion = fem::free_decay(one(0.012), one(omega), one(xi), time);
  EXPECT_NEAR(motion.displacement[0], 0.012, 1e-17);
  EXPECT_NEAR(motion.velocity[0], 0.0, 1e-15);
  const Eigen::VectorXd balance =
      motion.acceleration + 2.0 * xi * omega * motion.velocity + omega * omega * motion.displacement;
  EXPECT_LT(balance.cwiseAbs().maxCoeff(), 1e-14 * omega * omega);
}

TEST(FreeDecay, LosesEnergyAtTheRateOfItsDamping) {
  // Oracle: amplitude falls by e^(-2 pi xi / sqrt(1 - xi^2)) per cycle (logarithmic decrement).
  const double omega = 20.0, xi = 0.02, damped = omega * std::sqrt(1 - xi * xi), period = 2 * M_PI / damped;
  Eigen::VectorXd time(2);
  time << 0.0, period;
  const auto one = [](double value) { return Eigen::VectorXd::Constant(1, value); };
  const auto motion = fem::free_decay(one(1.0), one(omega), one(xi), time);
  EXPECT_NEAR(motion.displacement[1], std::exp(-xi * omega * period), 1e-14);
}

TEST(FreeDecay, IsTheSameOnEvenAndOnUnevenInstants) {
  // Oracle: the exponential at every instant by itself, which uneven instants need. 25 s at 1000 samples/s.
  const Eigen::VectorXd amplitude{{0.012, 3e-4}}, omega{{21.7, 180.0}}, ratio{{0.002, 0.005}};
  const Eigen::VectorXd even = Eigen::VectorXd::LinSpaced(25000, 0.0, 24.999);
  Eigen::VectorXd uneven(25001);
  uneven << even, 26.5;
  const auto fast = fem::free_decay(amplitude, omega, ratio, even),
             slow = fem::free_decay(amplitude, omega, ratio, uneven);
  for (const auto& [one, other] :
       {std::pair(&fast.displacement, &slow.displacement), std::pair(&fast.velocity, &slow.velocity),
        std::pair(&fast.acceleration, &slow.acceleration)})
    EXPECT_LT((*one - other->head(25000)).cwiseAbs().maxCoeff() / other->cwiseAbs().maxCoeff(), 1e-13);
}

TEST(FreeDecay, RefusesOverdampedModesAndUnequalLengths) {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1), two = Eigen::VectorXd::Ones(2);
  EXPECT_THROW(fem::free_decay(one, one, one, one), std::invalid_argument);
  EXPECT_THROW(fem::free_decay(one, two, 0.1 * one, one), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::free_decay_test
