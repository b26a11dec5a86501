#include "experiments/signal/decimation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace beamid::experiments {
namespace {

Eigen::VectorXd low_pass_kernel(int factor) {
  constexpr double pi = std::numbers::pi;
  constexpr double beta = 5.65;  // 60 dB
  const int half = 5 * factor;
  Eigen::VectorXd kernel(2 * half + 1);
  for (int k = -half; k <= half; ++k) {
    const double x = pi * k / factor, edge = static_cast<double>(k) / half;
    const double sinc = k == 0 ? 1 : std::sin(x) / x;
    kernel[k + half] = sinc * std::cyl_bessel_i(0, beta * std::sqrt(1 - edge * edge));
  }
  return kernel / kernel.sum();
}

}  // namespace

std::complex<double> DecimatedSignal::response(std::complex<double> rate) const {
  const std::complex<double> step = rate * interval / static_cast<double>(factor);
  const Eigen::Index half = kernel.size() / 2;
  std::complex<double> sum = 0;
  for (Eigen::Index k = 0; k < kernel.size(); ++k)
    sum += kernel[k] * std::exp(step * static_cast<double>(k - half));
  return sum;
}

int decimation_factor(double wanted, Eigen::Index most) {
  return static_cast<int>(std::clamp(wanted, 1.0, std::max(1.0, static_cast<double>(most))));
}

DecimatedSignal decimate(const Eigen::VectorXd& signal, double interval, int factor) {
  if (factor < 1)
    throw std::invalid_argument("decimation factor " + std::to_string(factor) + "; expected 1 or more");
  if (factor == 1) return {signal, interval, 0, 1, Eigen::VectorXd::Ones(1)};
  const Eigen::VectorXd kernel = low_pass_kernel(factor);
  const Eigen::Index length = kernel.size();
  if (signal.size() < length)
    throw std::invalid_argument("signal of " + std::to_string(signal.size()) +
                                " samples; expected at least " + std::to_string(length) + " to decimate by " +
                                std::to_string(factor));
  const Eigen::Index half = length / 2, count = (signal.size() - length) / factor + 1;
  DecimatedSignal result{Eigen::VectorXd(count), factor * interval, static_cast<double>(half) * interval,
                         factor, kernel};
  for (Eigen::Index m = 0; m < result.samples.size(); ++m)
    result.samples[m] = kernel.dot(signal.segment(m * factor, length));
  return result;
}

Eigen::MatrixXd decimate_channels(const Eigen::MatrixXd& channels, int factor) {
  Eigen::MatrixXd kept;
  for (Eigen::Index i = 0; i < channels.rows(); ++i) {
    const Eigen::VectorXd samples = decimate(channels.row(i).transpose(), 1.0, factor).samples;
    if (i == 0) kept.resize(channels.rows(), samples.size());
    kept.row(i) = samples.transpose();
  }
  return kept;
}

}  // namespace beamid::experiments
