#include "experiments/signal/sway.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

namespace beamid::experiments {
namespace {

Eigen::Index in_samples(const DecimatedSignal& signal, double period) {
  return std::max<Eigen::Index>(1, std::lround(period / signal.interval));
}

}  // namespace

Eigen::VectorXd sway(const DecimatedSignal& signal, double period) {
  using Eigen::VectorXd;
  const Eigen::Index half = in_samples(signal, period), left = signal.samples.size() - 2 * half;
  if (left < 1) return {};
  const VectorXd kernel =
      (VectorXd::LinSpaced(2 * half + 1, -std::numbers::pi, std::numbers::pi).array().cos() + 1) /
      static_cast<double>(2 * half);
  VectorXd mean(left);
  for (Eigen::Index k = 0; k < left; ++k) mean[k] = kernel.dot(signal.samples.segment(k, 2 * half + 1));
  return mean;
}

DecimatedSignal without_sway(DecimatedSignal signal, double period) {
  const Eigen::VectorXd slow = sway(signal, period);
  if (slow.size() == 0) return signal;
  const Eigen::Index half = in_samples(signal, period);
  signal.samples = (signal.samples.segment(half, slow.size()) - slow).eval();
  signal.start += signal.interval * static_cast<double>(half);
  return signal;
}

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
