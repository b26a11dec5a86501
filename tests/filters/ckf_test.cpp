// The cubature filter against its own definition.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "filters/filter.hpp"

namespace beamid::ckf_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry;

/// F(z) = [z1 + z2^2, z2 - z1 z3, z3 + z1^3 / 10], h(z) = [z1 z2, z3].
class Cubic final : public filters::DiscreteModel {
 public:
  explicit Cubic(int* calls = nullptr) : calls_(calls) {}
  std::vector<filters::Label> state_labels() const override { return std::vector<filters::Label>(3); }
  std::vector<filters::Label> output_labels() const override { return std::vector<filters::Label>(2); }
  const MatrixXd& process_noise() const override { return q_; }
  const MatrixXd& output_noise() const override { return r_; }
  double interval() const override { return 1.0; }
  void transition(const VectorXd& z, const VectorXd&, VectorXd& next) override {
    if (calls_) ++*calls_;
    next.resize(3);
    next << z[0] + z[1] * z[1], z[1] - z[0] * z[2], z[2] + 0.1 * z[0] * z[0] * z[0];
  }
  void output(const VectorXd& z, const VectorXd&, VectorXd& y) override {
    y.resize(2);
    y << z[0] * z[1], z[2];
  }

 private:
  int* calls_;
  MatrixXd q_ = 0.01 * MatrixXd::Identity(3, 3), r_ = 0.1 * MatrixXd::Identity(2, 2);
};

filters::Gaussian estimate() {
  filters::Gaussian result{VectorXd(3), MatrixXd(3, 3)};
  result.mean << 0.4, -0.7, 1.1;
  result.covariance << 0.5, 0.1, 0.0, 0.1, 0.3, -0.1, 0.0, -0.1, 0.4;
  return result;
}

// Sums over the 2n points m +- sqrt(n) L_i as [arasaratnam2009, eqs. 38-49] writes them, means subtracted as
// there.
template <class Function>
void cubature(const filters::Gaussian& prior, Index rows, const Function& f, VectorXd& mean,
              MatrixXd& covariance, MatrixXd& cross) {
  const Index n = prior.mean.size();
  const MatrixXd root = prior.covariance.llt().matrixL();
  MatrixXd points(n, 2 * n), values(rows, 2 * n);
  const double reach = std::sqrt(static_cast<double>(n)), weight = 0.5 / static_cast<double>(n);
  for (Index i = 0; i < 2 * n; ++i) {
    points.col(i) = prior.mean + (i < n ? reach : -reach) * root.col(i % n);
    VectorXd value;
    f(points.col(i), value);
    values.col(i) = value;
  }
  mean = weight * values.rowwise().sum();
  covariance = weight * values * values.transpose() - mean * mean.transpose();
  cross = weight * points * values.transpose() - prior.mean * mean.transpose();
}

class Cubature : public testing::TestWithParam<const char*> {};

TEST_P(Cubature, IsTheSumOverItsPoints) {
  Cubic model;
  const auto filter = filter_registry().make(GetParam(), {}, std::make_unique<Cubic>());
  filter->reset(estimate());
  filter->predict({});
  filters::Gaussian expected;
  MatrixXd cross, s;
  VectorXd y;
  cubature(
      estimate(), 3, [&](const VectorXd& z, VectorXd& v) { model.transition(z, {}, v); }, expected.mean,
      expected.covariance, cross);
  expected.covariance += model.process_noise();
  EXPECT_LT((filter->estimate().mean - expected.mean).norm(), 1e-14);
  EXPECT_LT((filter->estimate().covariance - expected.covariance).norm(), 1e-14);

  const VectorXd measured = VectorXd::Constant(2, 0.3);
  const auto correction = filter->correct(measured, {});
  cubature(
      expected, 2, [&](const VectorXd& z, VectorXd& v) { model.output(z, {}, v); }, y, s, cross);
  s += model.output_noise();
  const MatrixXd gain = cross * s.inverse();
  expected.mean += gain * (measured - y);
  expected.covariance -= gain * s * gain.transpose();
  EXPECT_LT((correction.innovation_covariance - s).norm(), 1e-13);
  EXPECT_LT((filter->estimate().mean - expected.mean).norm(), 1e-13);
  EXPECT_LT((filter->estimate().covariance - expected.covariance).norm(), 1e-13);
}

TEST_P(Cubature, TakesTwoPointsPerState) {
  int calls = 0;
  const auto filter = filter_registry().make(GetParam(), {}, std::make_unique<Cubic>(&calls));
  filter->reset(estimate());
  filter->predict({});
  EXPECT_EQ(calls, 6);
}

INSTANTIATE_TEST_SUITE_P(Both, Cubature, testing::Values("ckf", "srckf"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace beamid::ckf_test
