#include "experiments/modal/forced_mode.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "experiments/signal/fast_length.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

constexpr double lowest_ratio = 0.7, highest_ratio = 1.4;  // of the expected frequency
constexpr Index powers = 3;                                // of s, in every numerator

/// Lines first .. first + count - 1 of the transform of a signal.
VectorXcd lines_of(const VectorXd& signal, Index first, Index count) {
  const std::vector<double> samples(signal.data(), signal.data() + signal.size());
  std::vector<Complex> lines;
  Eigen::FFT<double> transform;
  transform.fwd(lines, samples);
  return Eigen::Map<const VectorXcd>(lines.data() + first, count);
}

/// Real rows of complex equations.
MatrixXd real_rows(const MatrixXcd& rows) {
  MatrixXd real(2 * rows.rows(), rows.cols());
  real << rows.real(), rows.imag();
  return real;
}

}  // namespace

ForcedMode forced_mode(const VectorXd& output, const MatrixXd& inputs, double interval, double expected_hz) {
  constexpr int iterations = 20;
  constexpr double largest_ratio = 0.3, explained = 0.5;
  const Index length = fast_length_within(output.size());
  const double line = 1 / (interval * static_cast<double>(length));  // [Hz]
  const auto first = static_cast<Index>(std::ceil(lowest_ratio * expected_hz / line)),
             last = std::min(length / 2 - 1, static_cast<Index>(highest_ratio * expected_hz / line));
  const Index count = last - first + 1, unknowns = 2 + powers * (inputs.rows() + 1);
  if (first < 1 || count < unknowns)
    throw std::invalid_argument(fmt::format(
        "{} lines of the spectrum lie between {:.4g} and {:.4g} Hz; expected at least {} for a forced mode",
        std::max<Index>(0, count), lowest_ratio * expected_hz, highest_ratio * expected_hz, unknowns));
  VectorXcd s(count);  // over the expected angular frequency
  for (Index k = 0; k < count; ++k) s[k] = Complex(0, static_cast<double>(first + k) * line / expected_hz);
  const VectorXcd y = lines_of(bridged_straight(output).head(length), first, count);
  MatrixXcd rows(count, unknowns);
  rows.col(0) = -s.cwiseProduct(y);
  rows.col(1) = -y;
  for (Index j = 0; j <= inputs.rows(); ++j) {
    VectorXcd input = VectorXcd::Ones(count);
    if (j < inputs.rows())
      input = lines_of(bridged_straight(inputs.row(j).transpose()).head(length), first, count);
    input /= std::max(1e-300, input.norm());
    for (Index power = 0; power < powers; ++power, input = s.cwiseProduct(input).eval())
      rows.col(2 + powers * j + power) = input * y.norm();
  }
  const VectorXcd right = s.array().square() * y.array();
  VectorXd weight = VectorXd::Ones(count), found = VectorXd::Zero(unknowns);
  double left = 1;
  for (int i = 0; i < iterations; ++i) {
    const MatrixXd a = real_rows(weight.asDiagonal() * rows);
    const VectorXd b = real_rows(weight.asDiagonal() * right);
    found = a.colPivHouseholderQr().solve(b);
    const VectorXcd factor = s.array().square() + found[0] * s.array() + found[1];
    // what is left of the output, with the left side divided by its factor
    left = (factor.cwiseProduct(y) - rows.rightCols(unknowns - 2) * found.tail(unknowns - 2))
               .cwiseQuotient(factor)
               .norm() /
           y.norm();
    weight = factor.cwiseAbs().cwiseInverse();
  }
  const double w = std::sqrt(found[1]), ratio = found[0] / (2 * w);
  if (!(w > lowest_ratio && w < highest_ratio && std::abs(ratio) < largest_ratio && left * left < explained))
    throw std::invalid_argument(
        fmt::format("no mode between {:.4g} and {:.4g} Hz explains the response to the measured inputs",
                    lowest_ratio * expected_hz, highest_ratio * expected_hz));
  return {w * expected_hz, ratio};
}

}  // namespace beamid::experiments
