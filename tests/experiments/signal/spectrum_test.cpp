// Lines of a spectrum at lengths of any factors.
#include "experiments/signal/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace beamid::experiments::spectrum_test {
namespace {

using Eigen::Index, Eigen::MatrixXd;
using Complex = std::complex<double>;

Complex line_of(const Eigen::VectorXd& x, Index k) {
  std::complex<long double> sum = 0.0L;
  const auto n = static_cast<long double>(x.size());
  for (Index j = 0; j < x.size(); ++j)
    sum += static_cast<long double>(x[j]) *
           std::polar(1.0L, -2.0L * std::numbers::pi_v<long double> *
                                static_cast<long double>((j * k) % x.size()) / n);
  return Complex(sum);
}

MatrixXd two_columns(Index n) {
  MatrixXd x(n, 2);
  for (Index j = 0; j < n; ++j)
    x.row(j) << std::sin(0.37 * static_cast<double>(j)) + 0.2 * std::cos(1.9 * static_cast<double>(j * j)),
        std::exp(-0.002 * static_cast<double>(j));
  return x;
}

// Oracle: the sum of the definition in extended precision, of a prime length and of one that is not, summed
// directly (few lines) and by the chirp transform (many).
TEST(LinesBetween, AreThoseOfTheDefinition) {
  for (const Index n : {4099, 4096})
    for (const Index count : {3, 700}) {
      const MatrixXd x = two_columns(n);
      constexpr Index first = 211;
      const Eigen::MatrixXcd lines = lines_between(x, first, count);
      ASSERT_EQ(lines.rows(), 2);
      ASSERT_EQ(lines.cols(), count);
      for (Index m = 0; m < count; m += 1 + count / 7)
        for (Index c = 0; c < 2; ++c)
          EXPECT_LT(std::abs(lines(c, m) - line_of(x.col(c), first + m)), 1e-13 * x.col(c).norm() * 64)
              << n << " samples, " << count << " lines, line " << first + m;
    }
}

TEST(LinesBetween, AreNoneWhereNoneIsWanted) {
  EXPECT_EQ(lines_between(two_columns(50), 3, 0).cols(), 0);
}

}  // namespace
}  // namespace beamid::experiments::spectrum_test
