// Oracle: the characteristic equation M s^2 + C s + K = 0 and its textbook roots [rao2018, ch. 2].
#include "experiments/models/oscillator.hpp"

#include <gtest/gtest.h>

namespace beamid::experiments::oscillator_test {
namespace {

constexpr double ratios[] = {0.0, 0.0015, 0.1, 0.7, 0.999};

TEST(Oscillator, HasTheEigenvalueOfItsCharacteristicEquation) {
  for (const double ratio : ratios) {
    const Oscillator o = Oscillator::from_frequency(3.0, 13.0, ratio);
    const std::complex<double> s = o.eigenvalue();
    EXPECT_LT(std::abs(o.mass * s * s + o.damping * s + o.stiffness), 1e-12 * o.stiffness) << ratio;
    EXPECT_GT(s.imag(), 0.0);
    EXPECT_LE(s.real(), 0.0);
  }
}

TEST(Oscillator, IsTheSameWrittenInEitherTerms) {
  for (const double ratio : ratios) {
    const Oscillator o = Oscillator::from_frequency(0.74, 26.0, ratio);
    EXPECT_NEAR(o.angular_frequency(), 26.0, 1e-13);
    EXPECT_NEAR(o.damping_ratio(), ratio, 1e-15);
    const Oscillator again = Oscillator::from_eigenvalue(o.mass, o.eigenvalue());
    EXPECT_NEAR(again.stiffness / o.stiffness, 1.0, 1e-14);
    EXPECT_NEAR(again.damping, o.damping, 1e-13);
  }
}

TEST(Oscillator, HasTheNumbersOfThePapersExample) {
  // Oracle: by hand, w = sqrt(515.8 / 3) = 13.11234 rad/s, C = 2 x 0.1 x sqrt(515.8 x 3) = 7.867401 N s/m.
  const Oscillator o{3.0, 515.8, 7.867401};
  EXPECT_NEAR(o.angular_frequency(), 13.11234, 1e-5);
  EXPECT_NEAR(o.frequency_hz(), 2.086893, 1e-6);
  EXPECT_NEAR(o.damping_ratio(), 0.1, 1e-8);
}

TEST(Oscillator, KeepsANegativeDamping) {
  const Oscillator o = Oscillator::from_eigenvalue(2.0, {0.5, 10.0});
  EXPECT_DOUBLE_EQ(o.damping, -2.0);
  EXPECT_DOUBLE_EQ(o.stiffness, 200.5);
}

}  // namespace
}  // namespace beamid::experiments::oscillator_test
