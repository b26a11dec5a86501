// Methods that take one mode at a time. Oracles: decays with known rates; closed forms of their spectra.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/modal/classic_estimators.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/mode_by_mode.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments::mode_by_mode_test {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd;

constexpr double interval = 0.01;
constexpr const char* methods[] = {"logarithmic_decrement", "hilbert_envelope", "half_power", "damped_sine"};

struct Mode {
  double frequency_hz, damping_ratio, amplitude, phase;

  Complex rate() const {
    return 2 * std::numbers::pi * frequency_hz *
           Complex(-damping_ratio, std::sqrt(1 - damping_ratio * damping_ratio));
  }
};

/// One channel: decays of these modes, an offset, white noise of this deviation.
MatrixXd decay(const std::vector<Mode>& modes, Index count, double noise, std::uint64_t seed = 1) {
  MatrixXd outputs = 0.2 + noise * standard_normal(count, seed, 1).transpose().array();
  for (Index k = 0; k < count; ++k)
    for (const Mode& mode : modes)
      outputs(0, k) += (mode.amplitude *
                        std::exp(Complex(0, mode.phase) + mode.rate() * interval * static_cast<double>(k)))
                           .real();
  return outputs;
}

std::vector<Pole> found_by(const std::string& method, const MatrixXd& outputs) {
  return modal_method_registry().make(method, {})->search(outputs, interval, 2).orders.at(0).poles;
}

// Without noise what is left is the neighbour's part behind the kernel, -60 dB.
TEST(ModeByMode, EveryMethodFindsTwoModesOfADecay) {
  const std::vector<Mode> modes{{5, 0.01, 1, 0.3}, {8, 0.015, 0.6, -1}};
  for (const char* method : methods) {
    const std::vector<Pole> found = found_by(method, decay(modes, 500, 0));
    ASSERT_EQ(found.size(), 2u) << method;
    for (std::size_t m = 0; m < 2; ++m) {
      EXPECT_NEAR(found[m].frequency_hz() / modes[m].frequency_hz, 1, 1e-4) << method;
      EXPECT_NEAR(found[m].damping_ratio() / modes[m].damping_ratio, 1, 0.01) << method;
    }
  }
}

// The mean over 40 records within 4 of its own deviations of the truth. The scatter between them is what each
// says of itself, or less: noise is taken for as dense as at the mode, where the kernel thins it out beside.
TEST(ModeByMode, EveryMethodIsUnbiasedAndKnowsItsScatter) {
  const std::vector<Mode> modes{{5, 0.01, 1, 0.3}, {8, 0.015, 0.6, -1}};
  constexpr int runs = 40;
  for (const char* method : methods) {
    double sum[2][2] = {}, squares[2][2] = {}, claimed[2][2] = {};
    for (int run = 0; run < runs; ++run) {
      const std::vector<Pole> found = found_by(method, decay(modes, 500, 0.02, 100 + run));
      ASSERT_EQ(found.size(), 2u) << method << " seed " << 100 + run;
      for (int m = 0; m < 2; ++m) {
        const double errors[] = {found[m].frequency_hz() - modes[m].frequency_hz,
                                 found[m].damping_ratio() - modes[m].damping_ratio};
        const double deviations[] = {found[m].frequency_deviation_hz, found[m].damping_ratio_deviation};
        for (int i = 0; i < 2; ++i) {
          sum[m][i] += errors[i] / runs;
          squares[m][i] += errors[i] * errors[i] / runs;
          claimed[m][i] += deviations[i] * deviations[i] / runs;
        }
      }
    }
    for (int m = 0; m < 2; ++m)
      for (int i = 0; i < 2; ++i) {
        EXPECT_LT(std::abs(sum[m][i]), 4 * std::sqrt(squares[m][i] / runs) + (i ? 5e-5 : 5e-4))
            << method << " mode " << m << (i ? " damping" : " frequency");
        const double claim = std::sqrt(claimed[m][i] / squares[m][i]);
        EXPECT_TRUE(claim > 0.7 && claim < 1.8)
            << claim << " " << method << " mode " << m << (i ? " damping" : " frequency");
      }
  }
}

TEST(ModeByMode, RefusesAModeTooNearToAnother) {
  const auto search = modal_method_registry()
                          .make("half_power", {})
                          ->search(decay({{5, 0.004, 1, 0}, {6, 0.004, 1, 0}}, 300, 0), interval, 2);
  EXPECT_TRUE(search.orders[0].poles.empty());
  ASSERT_EQ(search.refused.size(), 2u);
  EXPECT_NE(search.refused[0].reason.find("Hz from the next; expected"), std::string::npos);
}

// Oracle: the sum itself, and 1 / (1 + (distance / D)^2) of an endless record.
TEST(HalfPower, KnowsTheSpectrumOfADecay) {
  for (const double rate : {0.0, 0.3, 2.0})
    for (const double distance : {0.1, 1.0, 4.0}) {
      Complex sum = 0;
      double peak = 0;
      for (int m = 0; m < 300; ++m) {
        sum += std::exp(Complex(-rate, -distance) * interval * static_cast<double>(m));
        peak += std::exp(-rate * interval * m);
      }
      EXPECT_NEAR(relative_power(rate, distance, 300, interval), std::norm(sum) / (peak * peak), 1e-9);
    }
  EXPECT_NEAR(half_power_distance(1.5, 200000, 1e-4), 1.5, 1.5e-4);
}

// Oracle: the damping rate that the decay was made of. Over T = 1 / d the width alone is twice too large.
TEST(HalfPower, TakesTheFiniteRecordOffTheWidth) {
  constexpr Index count = 200;
  const double rate = 0.5;  // of 2 s
  Eigen::VectorXcd values(count);
  for (Index m = 0; m < count; ++m)
    values[m] = std::exp(Complex(-rate, 0.7) * interval * static_cast<double>(m));
  const HalfPowerPoints points = half_power_points(values, interval, 1);
  EXPECT_GT(points.distance(), 2 * rate);
  EXPECT_NEAR(damping_rate_of_distance(points.distance(), count, interval), rate, 1e-6);
  EXPECT_NEAR(points.centre(), 0.7, 1e-6);
  EXPECT_EQ(damping_rate_of_distance(0.5 * half_power_distance(0, count, interval), count, interval), 0);
}

// Oracle: differences of the points themselves.
TEST(HalfPower, KnowsWhatEveryValueDoesToThePoints) {
  Eigen::VectorXcd values(50);
  for (Index m = 0; m < 50; ++m) values[m] = std::exp(Complex(-2, 0.4) * interval * static_cast<double>(m));
  const HalfPowerPoints points = half_power_points(values, interval, 5);
  constexpr double change = 1e-5;
  for (const Index m : {0, 17, 40})
    for (const Complex direction : {Complex(1, 0), Complex(0, 1)}) {
      Eigen::VectorXcd changed = values;
      changed[m] += change * direction;
      const HalfPowerPoints after = half_power_points(changed, interval, 5);
      EXPECT_NEAR((after.centre() - points.centre()) / change, (points.centre_slope[m] * direction).real(),
                  1e-3);
      EXPECT_NEAR((after.distance() - points.distance()) / change,
                  (points.distance_slope[m] * direction).real(), 1e-3);
    }
}

// 2^-16 a line: of 30 records of 250 lines a fifth of a peak is expected.
TEST(SpectralPeaks, SeesNoneInNoise) {
  int peaks = 0;
  for (int seed = 0; seed < 30; ++seed)
    peaks += static_cast<int>(spectral_peaks(standard_normal(500, seed, 1).transpose(), interval).size());
  EXPECT_LE(peaks, 2);
}

// Oracle: the definition, with a median of its own around every value.
TEST(SpectralLines, AreThoseOfTheirDefinition) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const MatrixXd outputs = decay({{7.0, 0.01, 1.0, 0.3}, {21.0, 0.005, 0.2, 1.0}}, 1500, 0.3, seed);
    const LineSettings settings{.above_noise = 2, .above_valley = 0, .least = 0.02};
    const AmplitudeSpectrum spectrum = amplitude_spectrum(outputs.row(0).transpose(), interval);
    const Eigen::VectorXd& a = spectrum.amplitude;
    const auto lobe = static_cast<Index>(2 / (interval * 1500) / spectrum.frequency_hz[1]);
    const Index around = std::max<Index>(16 * lobe, a.size() / 8);
    std::vector<double> expected;
    for (Index k = lobe; k + 1 < a.size(); ++k) {
      const auto within = [&](Index reach) {
        const Index from = std::max<Index>(0, k - reach), to = std::min(a.size() - 1, k + reach);
        return Eigen::VectorXd(a.segment(from, to - from + 1));
      };
      if (a[k] >= settings.least * a.maxCoeff() && a[k] >= within(lobe).maxCoeff() &&
          a[k] >= settings.above_noise * median(within(around)))
        expected.push_back(spectrum.frequency_hz[k]);
    }
    std::vector<double> found;
    for (const SpectralLine& line : spectral_lines(outputs, interval, settings))
      found.push_back(line.frequency_hz);
    EXPECT_EQ(found, expected) << seed;
    EXPECT_GT(found.size(), 5u);
  }
}

}  // namespace
}  // namespace beamid::experiments::mode_by_mode_test
