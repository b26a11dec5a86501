#include "tests/experiments/modal/shaken_chain.hpp"

namespace beamid::test {

using namespace experiments;

Eigen::MatrixXd ShakenChain::record(Eigen::Index count, std::uint64_t seed) const {
  const Eigen::Index before = 600;  // to become stationary
  Eigen::MatrixXd outputs = Eigen::MatrixXd::Zero(2, count);
  for (int m = 0; m < 2; ++m) {
    const Mode mode = modes()[m];
    const double w = 2 * std::numbers::pi * mode.frequency_hz, d = mode.damping_ratio;
    const std::complex<double> step = std::exp(w * std::complex<double>(-d, std::sqrt(1 - d * d)) * interval);
    const Eigen::VectorXd noise = standard_normal(2 * (count + before), seed, 3 * m);
    std::complex<double> z = 0;
    for (Eigen::Index k = 0; k < count + before; ++k) {
      z = step * z + std::complex<double>(noise[2 * k], noise[2 * k + 1]);
      if (k < before) continue;
      outputs(0, k - before) += z.real();
      outputs(1, k - before) += (m == 0 ? 0.6 : -0.6) * z.real();
    }
  }
  const double size = std::sqrt(outputs.squaredNorm() / static_cast<double>(outputs.size()));
  for (int i = 0; i < 2; ++i)
    outputs.row(i) += 0.05 * size * standard_normal(count, seed, 20 + i).transpose();
  return outputs;
}

}  // namespace beamid::test
