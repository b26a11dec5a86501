// Chains, their convergence, and the likelihood's slopes. Oracles: laws of autoregressions, central
// differences, the normal distribution.
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/identify/posterior/posterior.hpp"
#include "experiments/identify/posterior/samplers.hpp"
#include "tests/experiments/identify/posterior/posterior_cases.hpp"

namespace beamid::experiments::samplers_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd autoregressions(double correlation, Index draws, Index chains) {
  MatrixXd values(draws, chains);
  for (Index c = 0; c < chains; ++c) {
    const VectorXd noise = filters::RandomStream(3, static_cast<std::uint64_t>(c)).normal(draws, 1);
    values(0, c) = noise[0];
    for (Index k = 1; k < draws; ++k)
      values(k, c) = correlation * values(k - 1, c) + std::sqrt(1 - correlation * correlation) * noise[k];
  }
  return values;
}

// (1 - r) / (1 + r) of the draws of an autoregression are independent ones.
TEST(ChainConvergence, CountsTheIndependentDrawsOfAnAutoregression) {
  for (const double r : {0.0, 0.5, 0.9}) {
    const ChainConvergence found = chain_convergence(autoregressions(r, 5000, 4));
    EXPECT_NEAR(found.effective_draws / (20000 * (1 - r) / (1 + r)), 1.0, 0.1) << r;
    EXPECT_LT(found.r_hat, 1.01);
  }
}

TEST(ChainConvergence, SeesAChainThatIsElsewhereOrWider) {
  MatrixXd elsewhere = autoregressions(0.0, 500, 4), wider = elsewhere;
  elsewhere.col(0).array() += 1.0;
  wider.col(0) *= 3.0;
  EXPECT_GT(chain_convergence(elsewhere).r_hat, 1.05);
  EXPECT_GT(chain_convergence(wider).r_hat, 1.05);
}

// Also with steps that are far too long or short the density is left as it is.
TEST(NoUTurn, LeavesANormalDensityAsItIs) {
  const ChainDensity normal = [](const VectorXd& y) -> ChainPlace { return {y, -0.5 * y.squaredNorm(), -y}; };
  for (const double step : {0.2, 1.0, 1.7}) {
    filters::RandomStream random(11);
    ChainPlace here = normal(VectorXd::Zero(2));
    double sum = 0.0, squares = 0.0, fourths = 0.0;
    constexpr int draws = 40000;
    for (int i = 0; i < draws; ++i) {
      here = no_u_turn(normal, here, step, random).end;
      sum += here.y[0] / draws;
      squares += here.y[0] * here.y[0] / draws;
      fourths += std::pow(here.y[1], 4) / draws;
    }
    EXPECT_NEAR(sum, 0.0, 0.03) << step;
    EXPECT_NEAR(squares, 1.0, 0.03) << step;
    EXPECT_NEAR(fourths, 3.0, 0.2) << step;
  }
}

TEST(ModalLikelihood, SlopesAreDifferences) {
  const VectorXd set{{52000.0, 58000.0, 65000.0}};
  const ModalCase frame = modal_case(three_storeys(), predicted_data(three_storeys(), set, 3), {0.01, 0.05});
  const VectorXd u{{0.3, -0.2, 0.1}};
  const LikelihoodValue value = frame.likelihood->at(u, true);
  for (Index j = 0; j < 3; ++j) {
    VectorXd step = VectorXd::Zero(3);
    step[j] = 1e-5;
    const double slope =
        (frame.likelihood->at(u + step, false).log - frame.likelihood->at(u - step, false).log) / 2e-5;
    EXPECT_NEAR(value.gradient[j], slope, 1e-5 * std::abs(slope) + 1e-4);
  }
}

// Log density of the frequencies as measured, by hand; |psi|^2 (1 - MAC) / s^2 is zero at the set itself.
TEST(ModalLikelihood, IsTheNormalDensityOfTheFrequencies) {
  const ModalCase chain =
      modal_case(two_storeys(""), measured_frequencies(two_storey_frequencies(958.61, 958.61), 0.02));
  double expected = 0.0;
  const std::vector<double> f = two_storey_frequencies(1000.0, 900.0),
                            measured = two_storey_frequencies(958.61, 958.61);
  for (std::size_t i = 0; i < 2; ++i) {
    const double s = 0.02 * measured[i];
    expected += -0.5 * std::pow((f[i] - measured[i]) / s, 2) - std::log(s * std::sqrt(2 * std::acos(-1.0)));
  }
  EXPECT_NEAR(chain.likelihood->at(*chain.likelihood->place(VectorXd{{1000.0, 900.0}}), false).log, expected,
              1e-9);
}

}  // namespace
}  // namespace beamid::experiments::samplers_test
