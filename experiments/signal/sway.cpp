#include "experiments/signal/sway.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

namespace beamid::experiments {
namespace {

Eigen::Index in_samples(double interval, double period) {
  return std::max<Eigen::Index>(1, std::lround(period / interval));
}

/// (2 half + 1), of sum 1.
Eigen::VectorXd hann_window(Eigen::Index half) {
  return (Eigen::VectorXd::LinSpaced(2 * half + 1, -std::numbers::pi, std::numbers::pi).array().cos() + 1) /
         static_cast<double>(2 * half);
}

}  // namespace

Eigen::VectorXd sway(const DecimatedSignal& signal, double period) {
  using Eigen::VectorXd;
  const Eigen::Index half = in_samples(signal.interval, period), left = signal.samples.size() - 2 * half;
  if (left < 1) return {};
  const VectorXd kernel = hann_window(half);
  VectorXd mean(left);
  for (Eigen::Index k = 0; k < left; ++k) mean[k] = kernel.dot(signal.samples.segment(k, 2 * half + 1));
  return mean;
}

DecimatedSignal without_sway(DecimatedSignal signal, double period) {
  const Eigen::VectorXd slow = sway(signal, period);
  if (slow.size() == 0) return signal;
  const Eigen::Index half = in_samples(signal.interval, period);
  signal.samples = (signal.samples.segment(half, slow.size()) - slow).eval();
  signal.start += signal.interval * static_cast<double>(half);
  return signal;
}

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

std::complex<double> response_without_sway(std::complex<double> rate, double interval, double period) {
  const Index half = in_samples(interval, period);
  const VectorXd kernel = hann_window(half);
  std::complex<double> mean = 0.0;
  for (Index k = -half; k <= half; ++k)
    mean += kernel[k + half] * std::exp(rate * (interval * static_cast<double>(k)));
  return 1.0 - mean;
}

Drift drift_beneath(const VectorXd& signal, double interval, double period) {
  constexpr Index fewest_samples = 4, fewest_periods = 10;
  constexpr int most_turns = 3;
  const Index half = in_samples(interval, period), hop = half / 2;
  if (half < fewest_samples || signal.size() < fewest_periods * half) return {};
  const VectorXd kernel = hann_window(half);
  const Index count = (signal.size() - kernel.size()) / hop + 1;
  VectorXd mean(count), square(count);
  for (Index k = 0; k < count; ++k) {
    const auto part = signal.segment(k * hop, kernel.size());
    mean[k] = kernel.dot(part);
    square[k] = kernel.dot((part.array() - mean[k]).square().matrix());
  }
  VectorXd slow = 0.25 * (mean.head(count - 2) + mean.tail(count - 2)) + 0.5 * mean.segment(1, count - 2);
  slow.array() -= slow.mean();
  const double range = slow.maxCoeff() - slow.minCoeff();
  if (!(range > 0.0)) return {};
  int turns = 0, direction = 0;  // of the last change that counts
  double extreme = slow[0];
  for (const double value : slow) {
    const double change = value - extreme, least = 0.1 * range;
    if (direction == 0 ? std::abs(change) > least : direction * change < -least) {
      turns += direction == 0 ? 0 : 1;
      direction = change > 0.0 ? 1 : -1;
      extreme = value;
    } else if (direction * change > 0.0) {
      extreme = value;
    }
  }
  if (turns > most_turns) return {};
  const Index span = std::min<Index>(8, slow.size() - 1);  // four periods
  const double steepest =
      (slow.tail(slow.size() - span) - slow.head(slow.size() - span)).cwiseAbs().maxCoeff();
  const double motion = std::sqrt(std::max(square.mean(), 1e-300));
  return {slow.norm() / std::sqrt(static_cast<double>(slow.size())) / motion, steepest / range};
}

LocalMotion local_motion(const VectorXd& signal, double interval, double frequency_hz) {
  constexpr double fewest = 4, periods = 2;
  const double samples = 1 / (frequency_hz * interval);  // per period
  const auto length = static_cast<Index>(std::lround(periods * samples)),
             hop = std::max<Index>(1, std::lround(samples / LocalMotion::windows_per_period));
  if (!(samples >= fewest) || signal.size() < length) return {};
  MatrixXd basis(length, 5);
  for (Index k = 0; k < length; ++k) {
    const double from_middle = static_cast<double>(k) - 0.5 * static_cast<double>(length - 1),
                 s = from_middle / static_cast<double>(length),
                 angle = 2 * std::numbers::pi * from_middle / samples;
    basis.row(k) << 1, s, s * s, std::cos(angle), std::sin(angle);
  }
  const MatrixXd inverse = basis.colPivHouseholderQr().solve(MatrixXd::Identity(length, length));
  const Index count = (signal.size() - length) / hop + 1;
  LocalMotion motion{VectorXd(count), VectorXd(count), VectorXd(count)};
  for (Index i = 0; i < count; ++i) {
    const VectorXd found = inverse * signal.segment(i * hop, length);
    motion.time[i] = interval * (static_cast<double>(i * hop) + 0.5 * static_cast<double>(length - 1));
    motion.amplitude[i] = std::hypot(found[3], found[4]);
    motion.offset[i] = found[0];
  }
  return motion;
}

}  // namespace beamid::experiments
