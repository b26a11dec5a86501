// Oracle: the amplitude a sine is made with.
#include "experiments/signal/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace beamid::experiments::amplitude_spectrum_test {
namespace {

TEST(AmplitudeSpectrum, PeaksAtASinesAmplitude) {
  const double dt = 1e-3, frequency = 62.5;  // a multiple of 1 / (2048 dt): no loss between lines
  const Eigen::VectorXd signal = Eigen::VectorXd::NullaryExpr(1000, [&](Eigen::Index k) {
    return 5.0 + 3.0 * std::sin(2 * std::numbers::pi * frequency * dt * static_cast<double>(k));
  });
  const AmplitudeSpectrum spectrum = amplitude_spectrum(signal, dt);
  Eigen::Index at = 0;
  EXPECT_NEAR(spectrum.amplitude.maxCoeff(&at), 3.0, 1e-3);
  EXPECT_NEAR(spectrum.frequency_hz[at], frequency, 1e-12);
  EXPECT_NEAR(spectrum.frequency_hz[spectrum.frequency_hz.size() - 1], 500.0, 1e-9);
}

}  // namespace
}  // namespace beamid::experiments::amplitude_spectrum_test
