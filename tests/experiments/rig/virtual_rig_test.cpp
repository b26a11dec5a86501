// Oracle, unless said otherwise: superposition of the continuum's exact modes, no mesh.
#include "experiments/rig/virtual_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/exact/exact_cantilever.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments::virtual_rig_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

Release release_of(double tip_mass) {
  Release settings;
  settings.beam = test::steel_beam(tip_mass);
  return settings;
}

fem::Motion exact_motion(const Release& settings, const fem::Cantilever& beam, const VectorXd& time) {
  VectorXd amplitude(settings.modes), omega(settings.modes),
      ratio = VectorXd::Constant(settings.modes, settings.higher_damping_ratio);
  ratio[0] = settings.first_damping_ratio;
  for (int i = 0; i < settings.modes; ++i) {
    const fem::ExactMode mode(beam, i + 1);
    amplitude[i] = mode.release_amplitude(settings.tip_deflection);
    omega[i] = mode.angular_frequency();
  }
  return fem::free_decay(amplitude, omega, ratio, time);
}

double relative_difference(const VectorXd& found, const VectorXd& expected) {
  return (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

TEST(VirtualRig, MovesTheTipAsTheContinuumDoes) {
  for (const test::KnownBeam& known : test::five_beams) {
    const Release settings = release_of(known.tip_mass);
    const ReleasedBeam released = release(settings);
    const fem::Motion exact = exact_motion(settings, test::steel_beam(known.tip_mass), released.time);
    EXPECT_LT(relative_difference(released.tip.displacement, exact.displacement), 2e-6) << known.tip_mass;
    EXPECT_LT(relative_difference(released.tip.velocity, exact.velocity), 5e-5) << known.tip_mass;
    EXPECT_LT(relative_difference(released.tip.acceleration, exact.acceleration), 2e-3) << known.tip_mass;
  }
}

TEST(VirtualRig, StartsFromRestAtTheGivenDeflection) {
  // Oracle: the static shape holds all modes; what eight of them leave of 12 mm is the tabulated tail.
  const ReleasedBeam released = release(release_of(0.360490));
  EXPECT_NEAR(released.tip.displacement[0], 0.012, 1e-6);
  EXPECT_NEAR(released.tip.velocity[0], 0.0, 1e-18);
  EXPECT_NEAR(released.modal_amplitudes.sum(), released.tip.displacement[0], 1e-15);
}

TEST(VirtualRig, SamplesAtItsRate) {
  Release settings = release_of(0.360490);
  settings.duration = 2.0;
  settings.sampling_rate = 512.0;
  const ReleasedBeam released = release(settings);
  ASSERT_EQ(released.time.size(), 1025);
  EXPECT_EQ(released.time[0], 0.0);
  EXPECT_EQ(released.time[512], 1.0);
  EXPECT_EQ(released.time[1024], 2.0);
}

class Accelerometer : public testing::Test {
 protected:
  ReleasedBeam beam = release(release_of(1.338090));
};

TEST_F(Accelerometer, AddsWhiteNoiseOfTheGivenLevel) {
  // Oracle: mean, standard deviation and lag-one correlation of n white samples, within 4 standard errors.
  const Record record = measure_acceleration(beam, 0.05, 2009, 1);
  const VectorXd noise = record.channel(Quantity::acceleration) - beam.tip.acceleration;
  const double n = static_cast<double>(noise.size()), root = std::sqrt(n);
  EXPECT_NEAR(noise.mean(), 0.0, 4.0 * 0.05 / root);
  EXPECT_NEAR(std::sqrt(noise.squaredNorm() / n), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * n));
  EXPECT_NEAR(noise.head(noise.size() - 1).dot(noise.tail(noise.size() - 1)) / noise.squaredNorm(), 0.0,
              4.0 / root);
  EXPECT_EQ(record.time, beam.time);
}

TEST_F(Accelerometer, ReadsTheTruthWithoutNoise) {
  EXPECT_EQ(measure_acceleration(beam, 0.0, 1, 0).channel(Quantity::acceleration), beam.tip.acceleration);
}

TEST_F(Accelerometer, GivesTheSameBytesForTheSameSeed) {
  const Record record = measure_acceleration(beam, 0.05, 7, 2);
  EXPECT_EQ(record.samples, measure_acceleration(release(release_of(1.338090)), 0.05, 7, 2).samples);
  EXPECT_NE(record.samples, measure_acceleration(beam, 0.05, 8, 2).samples);
  EXPECT_NE(record.samples, measure_acceleration(beam, 0.05, 7, 3).samples);
}

}  // namespace
}  // namespace beamid::experiments::virtual_rig_test
