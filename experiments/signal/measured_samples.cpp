#include "experiments/signal/measured_samples.hpp"

#include <cmath>

namespace beamid::experiments {

using Eigen::Index;

Eigen::VectorXd first_fill(const Eigen::VectorXd& signal) {
  if (signal.allFinite()) return signal;
  Eigen::VectorXd bridged = Eigen::VectorXd::Zero(signal.size());
  Index last = -1;  // sample that was measured
  for (Index k = 0; k < signal.size(); ++k) {
    if (!std::isfinite(signal[k])) continue;
    if (last < 0) bridged.head(k).setConstant(signal[k]);
    for (Index j = last + 1; last >= 0 && j < k; ++j)
      bridged[j] = signal[last] +
                   (signal[k] - signal[last]) * static_cast<double>(j - last) / static_cast<double>(k - last);
    bridged[k] = signal[k];
    last = k;
  }
  if (last >= 0) bridged.tail(signal.size() - 1 - last).setConstant(signal[last]);
  return bridged;
}

double largest_measured(const Eigen::MatrixXd& samples) {
  return samples.array().isFinite().select(samples.array().abs(), 0.0).maxCoeff();
}

}  // namespace beamid::experiments
