// Oracle: least squares over all measurements at once.
#include "experiments/identify/family/beam_family.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <utility>

namespace beamid::experiments::shared_estimate_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

struct Linear {
  MatrixXd rows;   // of the record's own unknowns
  VectorXd found;  // with noise of unit deviation

  // What a Kalman filter makes of it, from a prior that says next to nothing; mean without the prior.
  NamedEstimate estimate(std::vector<std::string> names, double prior = 1e4) const {
    const MatrixXd before = prior * prior * MatrixXd::Identity(rows.cols(), rows.cols());
    const MatrixXd information = rows.transpose() * rows;
    NamedEstimate result;
    result.names = std::move(names);
    result.estimate.prior = before;
    result.estimate.unknowns.covariance = (information + before.inverse()).inverse();
    result.estimate.unknowns.mean = result.estimate.unknowns.covariance * (rows.transpose() * found);
    result.estimate.start = VectorXd::Zero(rows.cols());
    return result;
  }
};

// Each record has one measurement of a combination of a and b, which by itself tells neither; c is the
// second's.
TEST(SharedEstimate, IsThatOfAllMeasurementsAtOnce) {
  const Linear first{MatrixXd{{3.0, 1.0}}, VectorXd::Constant(1, 5.1)},
      second{MatrixXd{{2.0, -1.0, 0.5}, {0.0, 0.0, 4.0}}, Eigen::Vector2d(0.4, 8.2)},
      third{MatrixXd{{1.0, 1.0}}, VectorXd::Constant(1, 3.0)};
  const SharedEstimate joint = shared_estimate(
      {first.estimate({"a", "b"}), second.estimate({"a", "b", "c"}), third.estimate({"b", "a"})});
  EXPECT_EQ(joint.names, (std::vector<std::string>{"a", "b", "c"}));
  MatrixXd all(4, 3);
  all << 3.0, 1.0, 0.0, 2.0, -1.0, 0.5, 0.0, 0.0, 4.0, 1.0, 1.0, 0.0;
  const Eigen::Vector4d y(5.1, 0.4, 8.2, 3.0);
  const VectorXd mean = all.colPivHouseholderQr().solve(y);
  EXPECT_LT((joint.unknowns.mean - mean).norm(), 1e-6);
  EXPECT_LT((joint.unknowns.covariance - (all.transpose() * all).inverse()).norm(), 1e-6);
  EXPECT_NEAR(joint.chi_squared, (y - all * mean).squaredNorm(), 1e-6);
  EXPECT_EQ(joint.freedom, 1.0);
}

TEST(SharedEstimate, SaysThatRecordsDisagree) {
  const Linear first{MatrixXd::Identity(1, 1), VectorXd::Constant(1, 0.0)},
      second{MatrixXd::Identity(1, 1), VectorXd::Constant(1, 10.0)};
  const SharedEstimate joint = shared_estimate({first.estimate({"a"}), second.estimate({"a"})});
  EXPECT_LT(joint.probability, 1e-9);
  EXPECT_NEAR(joint.scatter, std::sqrt(50.0), 1e-3);
  EXPECT_NEAR(std::sqrt(joint.unknowns.covariance(0, 0)), 5.0, 1e-3);
}

TEST(SharedEstimate, LeavesUncertainWhatNoRecordTells) {
  const Linear first{(MatrixXd(1, 2) << 1.0, 1.0).finished(), VectorXd::Constant(1, 2.0)};
  const SharedEstimate joint = shared_estimate({first.estimate({"a", "b"}), first.estimate({"a", "b"})});
  EXPECT_GT(joint.unknowns.deviations().minCoeff(), 1e4);
}

}  // namespace
}  // namespace beamid::experiments::shared_estimate_test
