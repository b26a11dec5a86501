#include "experiments/signal/sway.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

}  // namespace beamid::experiments
