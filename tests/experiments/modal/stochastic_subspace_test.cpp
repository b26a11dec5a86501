// Stochastic subspace identification on chains of masses whose modes are known.
#include "experiments/modal/subspace_realisation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/experiments/modal/shaken_chain.hpp"

namespace beamid::experiments::stochastic_subspace_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// The pole of a given order nearest to a frequency.
Pole nearest(const StochasticSubspace& found, int order, double frequency_hz) {
  for (const OrderPoles& at : found.orders)
    if (at.order == order)
      return *std::min_element(at.poles.begin(), at.poles.end(), [&](const Pole& a, const Pole& b) {
        return std::abs(a.frequency_hz() - frequency_hz) < std::abs(b.frequency_hz() - frequency_hz);
      });
  throw std::logic_error("no such order");
}

// Oracle: the chain's own modes, and the scatter of the estimates over seeded runs. With 60 runs the scatter
// itself is known within 9 % (one standard deviation).
TEST(StochasticSubspace, KnowsItsOwnScatter) {
  const test::ShakenChain chain;
  constexpr int runs = 60;
  StochasticSettings settings;
  settings.rows = 12;
  for (const auto& mode : chain.modes()) {
    VectorXd frequency(runs), damping(runs), shape(runs);
    double frequency_variance = 0, damping_variance = 0, shape_variance = 0;
    for (int run = 0; run < runs; ++run) {
      const auto found = stochastic_subspace(chain.record(6000, run), chain.interval, 4, settings);
      const Pole pole = nearest(found, 4, mode.frequency_hz);
      frequency[run] = pole.frequency_hz();
      damping[run] = pole.damping_ratio();
      shape[run] = pole.shape.cwiseAbs().minCoeff() / pole.shape.cwiseAbs().maxCoeff();
      frequency_variance += std::pow(pole.frequency_deviation_hz, 2) / runs;
      damping_variance += std::pow(pole.damping_ratio_deviation, 2) / runs;
      shape_variance += pole.shape_deviation.squaredNorm() / runs;  // 1 is exact
    }
    const auto scatter = [](const VectorXd& values) {
      return std::sqrt((values.array() - values.mean()).square().sum() / (runs - 1));
    };
    EXPECT_NEAR(std::sqrt(frequency_variance) / scatter(frequency), 1, 0.3);
    EXPECT_NEAR(std::sqrt(damping_variance) / scatter(damping), 1, 0.3);
    EXPECT_NEAR(std::sqrt(shape_variance) / scatter(shape), 1, 0.3);
    // Bias within 3.3 standard errors of the mean, and the 1/N of an autocorrelation for damping.
    EXPECT_NEAR(frequency.mean(), mode.frequency_hz, 3.3 * scatter(frequency) / std::sqrt(runs));
    EXPECT_NEAR(damping.mean(), mode.damping_ratio,
                3.3 * scatter(damping) / std::sqrt(runs) + 0.02 * mode.damping_ratio);
    EXPECT_NEAR(shape.mean(), mode.shape_ratio, 3.3 * scatter(shape) / std::sqrt(runs));
  }
}

TEST(StochasticSubspace, NamesWhatItRefuses) {
  const test::ShakenChain chain;
  const Eigen::MatrixXd record = chain.record(1000, 1);
  StochasticSettings settings;
  settings.rows = 20;
  EXPECT_THROW(stochastic_subspace(record, chain.interval, 4, settings), std::invalid_argument);
  EXPECT_THROW(stochastic_subspace(record, 0, 4), std::invalid_argument);
  EXPECT_THROW(stochastic_subspace(record * std::nan(""), chain.interval, 4), std::invalid_argument);
  EXPECT_THROW(stochastic_subspace(record * 0, chain.interval, 4), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::stochastic_subspace_test
