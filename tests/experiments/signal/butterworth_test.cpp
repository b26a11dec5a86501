#include "experiments/signal/butterworth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace beamid::experiments::butterworth_test {
namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;
using Design = CascadedFilter (*)(int, double, double);

double gain(const CascadedFilter& filter, double frequency_hz) {
  return std::abs(response(filter, Complex(0, 2 * pi * frequency_hz)));
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> c(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  return c;
}

void expect_polynomials(const CascadedFilter& filter, const std::vector<double>& numerator,
                        const std::vector<double>& denominator) {
  std::vector<double> b{1}, a{1};
  for (const Biquad& section : filter.sections) {
    b = product(b, {section.b0, section.b1, section.b2});
    a = product(a, {1, section.a1, section.a2});
  }
  for (std::size_t i = 0; i < numerator.size(); ++i) {
    EXPECT_NEAR(b[i], numerator[i], 1e-12) << i;
    EXPECT_NEAR(a[i], denominator[i], 1e-12) << i;
  }
}

// Oracle: the definition |H|^2 = 1 / (1 + W^(2n)), W = tan(pi f dt) / tan(pi corner dt).
TEST(Butterworth, HasTheGainOfItsDefinitionAtEveryOrder) {
  const double interval = 1e-3, corner = 20;
  for (int order = 1; order <= 8; ++order)
    for (const double f : {0.5, 3.0, 19.0, 20.0, 30.0, 200.0, 480.0}) {
      const double W = std::tan(pi * f * interval) / std::tan(pi * corner * interval);
      const double power = std::pow(W, 2 * order);
      EXPECT_NEAR(gain(butterworth_low_pass(order, corner, interval), f), 1 / std::sqrt(1 + power), 1e-9);
      EXPECT_NEAR(gain(butterworth_high_pass(order, corner, interval), f), 1 / std::sqrt(1 + 1 / power),
                  1e-9);
    }
}

// Oracle: half power at the corner, 20 dB per decade and order far from it; the 0.5 Hz high-pass of the
// study.
TEST(Butterworth, LosesHalfThePowerAtTheCornerAndTwentyDecibelsPerDecadeAndOrder) {
  for (int order = 1; order <= 8; ++order) {
    const CascadedFilter filter = butterworth_high_pass(order, 0.5, 1e-3);
    EXPECT_NEAR(gain(filter, 0.5), std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(gain(filter, 5e-3) / gain(filter, 5e-4), std::pow(10.0, order), 1e-3 * std::pow(10.0, order));
  }
}

// Oracle: scipy 1.10.1, signal.butter(4, 0.5, 'highpass', fs=100) and signal.butter(5, 10, 'lowpass',
// fs=100).
TEST(Butterworth, HasTheCoefficientsOfScipy) {
  expect_polynomials(
      butterworth_high_pass(4, 0.5, 0.01),
      {0.9597822300872386, -3.8391289203489545, 5.7586933805234315, -3.8391289203489545, 0.9597822300872386},
      {1.0, -3.9179078653919865, 5.7570763791180655, -3.7603495076945257, 0.921181929191236});
  expect_polynomials(butterworth_low_pass(5, 10, 0.01),
                     {0.0012825810789606855, 0.006412905394803428, 0.012825810789606856, 0.012825810789606856,
                      0.006412905394803428, 0.0012825810789606855},
                     {1.0, -2.9754221097456828, 3.806018119320411, -2.5452528683304667, 0.8811300754378364,
                      -0.1254306221553556});
}

// Oracle: the impulse response, summed against e^(-s t), is the response at s (definition of H).
TEST(Butterworth, FiltersAsItsResponseSays) {
  const CascadedFilter filter = cascade(butterworth_high_pass(3, 5, 1e-3), butterworth_low_pass(4, 60, 1e-3));
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(4000);
  impulse[0] = 1;
  const Eigen::VectorXd out = filter_causally(filter, impulse);
  for (const Complex rate : {Complex(0, 30), Complex(-0.5, 100), Complex(1.0, 700)}) {
    Complex sum = 0;
    for (Eigen::Index k = 0; k < out.size(); ++k)
      sum += out[k] * std::exp(-rate * (1e-3 * static_cast<double>(k)));
    EXPECT_NEAR(std::abs(sum - response(filter, rate)), 0, 1e-10);
  }
}

TEST(Butterworth, RefusesWhatItCannotBe) {
  for (const Design design : {butterworth_low_pass, butterworth_high_pass}) {
    EXPECT_THROW(design(0, 10, 1e-3), std::invalid_argument);
    EXPECT_THROW(design(9, 10, 1e-3), std::invalid_argument);
    EXPECT_THROW(design(2, 500, 1e-3), std::invalid_argument);
    EXPECT_THROW(design(2, -1, 1e-3), std::invalid_argument);
    EXPECT_THROW(design(2, std::nan(""), 1e-3), std::invalid_argument);
    EXPECT_THROW(design(2, 10, 0), std::invalid_argument);
  }
  try {
    butterworth_high_pass(2, 600, 1e-3);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "corner frequency 600 Hz; expected a value between 0 and 500 Hz, half the sampling rate");
  }
}

}  // namespace
}  // namespace beamid::experiments::butterworth_test
