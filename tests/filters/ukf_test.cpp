#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/linear_model.hpp"
#include "filters/filter_run.hpp"

namespace beamid::ukf_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry;

TEST(Ukf, WeightsSumToOneForTheSmallestSpread) {
  // A widespread implementation's weights sum to 1 + 2.9e-5 at alpha = 1e-3; its mean then drifts by that
  // factor per step. In difference form the sum is exactly one: a far-away constant state stays where it is.
  auto model = test::two_state_model();
  model.a.setIdentity();
  model.c << 0, 0;  // nothing is learnt
  const auto filter =
      filter_registry().make("ukf", {{"alpha", 1e-3}}, std::make_unique<test::LinearModel>(model));
  const VectorXd far = VectorXd::Constant(2, 1e6);
  const filters::Measurements record{VectorXd::LinSpaced(1000, 0, 999), MatrixXd::Zero(1, 1000), {}};
  const auto result = run(*filter, {far, MatrixXd::Identity(2, 2)}, record);
  EXPECT_LT((result.last.mean - far).norm() / far.norm(), 1e-12);
}

TEST(Ukf, EqualsTheEkfOnALinearModelForAnySpread) {
  const VectorXd time = VectorXd::LinSpaced(200, 0, 199);
  const filters::Measurements record{time, (0.05 * time.array()).sin().matrix().transpose(), {}};
  const filters::Gaussian initial{VectorXd::Zero(2), MatrixXd::Identity(2, 2)};
  const auto ekf =
      filter_registry().make("ekf", {}, std::make_unique<test::LinearModel>(test::two_state_model()));
  const auto expected = run(*ekf, initial, record).last;
  for (const double alpha : {1.0, 0.5, 1e-2, 1e-3}) {
    const auto ukf = filter_registry().make("ukf", {{"alpha", alpha}},
                                            std::make_unique<test::LinearModel>(test::two_state_model()));
    const auto found = run(*ukf, initial, record).last;
    EXPECT_LT((found.mean - expected.mean).norm(), 1e-10) << alpha;
    EXPECT_LT((found.covariance - expected.covariance).norm(), 1e-10 * expected.covariance.norm()) << alpha;
  }
}

TEST(Ukf, RefusesSpreadsThatBreakPositivity) {
  const auto make = [](const filters::Options& options) {
    return filter_registry().make("ukf", options,
                                  std::make_unique<test::LinearModel>(test::two_state_model()));
  };
  EXPECT_THROW(make({{"alpha", 0.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"kappa", -2.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"alpha", 2.0}}), std::invalid_argument);  // beta = 2 < alpha^2
}

TEST(Ukf, RefusesSigmaPointsThatRoundingSwallows) {
  const auto make = [](double alpha) {
    return filter_registry().make("ukf", {{"alpha", alpha}},
                                  std::make_unique<test::LinearModel>(test::two_state_model()));
  };
  EXPECT_NO_THROW(make(1e-4));  // the smallest in use [wan2000]
  EXPECT_THROW(make(1e-6), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::ukf_test
