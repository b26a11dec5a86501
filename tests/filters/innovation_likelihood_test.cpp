// Parameters by the likelihood of a Kalman filter's innovations.
#include "filters/innovation_likelihood.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

namespace beamid::innovation_likelihood_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// x+ = theta x + u + w, y = x + v: state [x, theta].
class Autoregression final : public filters::DiscreteModel {
 public:
  std::vector<filters::Label> state_labels() const override { return {{"x", ""}, {"theta", ""}}; }
  std::vector<filters::Label> output_labels() const override { return {{"y", ""}}; }
  const MatrixXd& process_noise() const override { return q_; }
  const MatrixXd& output_noise() const override { return r_; }
  double interval() const override { return 1.0; }
  void transition(const VectorXd& z, const VectorXd& u, VectorXd& next) override {
    next = z;
    next[0] = z[1] * z[0] + u[0];
  }
  void output(const VectorXd& z, const VectorXd&, VectorXd& y) override { y = z.head(1); }

 private:
  MatrixXd q_{{0.3, 0.0}, {0.0, 0.0}}, r_{{0.2}};
};

constexpr double truth = 0.8;

filters::Measurements some_record(Index samples, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  filters::Measurements record{VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1)),
                               MatrixXd(1, samples), MatrixXd(1, samples)};
  double x = normal(random);
  for (Index k = 0; k < samples; ++k) {
    record.inputs(0, k) = std::sin(0.3 * static_cast<double>(k));
    record.outputs(0, k) = x + std::sqrt(0.2) * normal(random);
    x = truth * x + record.inputs(0, k) + std::sqrt(0.3) * normal(random);
  }
  return record;
}

filters::Gaussian known() {
  return {Eigen::Vector2d(0.0, 0.5), Eigen::Vector2d(1.0, 100.0).asDiagonal(), {}};
}

// Of all outputs at once: their mean and covariance at theta.
double dense_cost(const filters::Measurements& record, double theta) {
  const Index n = record.size();
  VectorXd mean(n);
  MatrixXd covariance(n, n);
  double x = 0.0, variance = 1.0;
  for (Index k = 0; k < n; ++k) {
    mean[k] = x;
    for (Index j = k; j < n; ++j)
      covariance(k, j) = covariance(j, k) = variance * std::pow(theta, static_cast<double>(j - k));
    covariance(k, k) += 0.2;
    x = theta * x + record.inputs(0, k);
    variance = theta * theta * variance + 0.3;
  }
  const VectorXd rest = record.outputs.row(0).transpose() - mean;
  const Eigen::LLT<MatrixXd> factor(covariance);
  return 0.5 * rest.dot(factor.solve(rest)) + MatrixXd(factor.matrixL()).diagonal().array().log().sum();
}

TEST(InnovationLikelihood, HasItsMaximumWhereTheDensityOfAllOutputsHasIt) {
  // Oracle: the joint Gaussian of the outputs, minimised by golden section.
  const filters::Measurements record = some_record(60, 4);
  double from = 0.3, to = 1.1;
  const double golden = 1.0 / std::numbers::phi;
  while (to - from > 1e-9) {
    const double a = to - golden * (to - from), b = from + golden * (to - from);
    (dense_cost(record, a) < dense_cost(record, b) ? to : from) =
        dense_cost(record, a) < dense_cost(record, b) ? b : a;
  }
  Autoregression model;
  const filters::InnovationFit fit = filters::fit_innovations(
      filters::held_problem(model, record, {1}, known()), VectorXd::Constant(1, 0.5));
  EXPECT_TRUE(fit.converged);
  const double deviation = 1.0 / std::sqrt(fit.information(0, 0));
  EXPECT_NEAR(fit.constants[0], 0.5 * (from + to), 1e-3 * deviation);
  const double prior = 0.5 * std::pow(fit.constants[0] - 0.5, 2) / 100.0;
  EXPECT_NEAR(fit.cost, dense_cost(record, fit.constants[0]) + prior, 1e-9);
}

TEST(InnovationLikelihood, ScattersAsItsInformationSays) {
  // Oracle: 400 seeded records. Their standard deviation is known to 3.5 %, the mean to 5 % of it.
  constexpr int runs = 400;
  VectorXd errors(runs);
  double bound = 0.0;
  for (int run = 0; run < runs; ++run) {
    const filters::Measurements record = some_record(200, 100 + static_cast<unsigned>(run));
    Autoregression model;
    const filters::InnovationFit fit = filters::fit_innovations(
        filters::held_problem(model, record, {1}, known()), VectorXd::Constant(1, 0.7));
    errors[run] = fit.constants[0] - truth;
    bound += 1.0 / std::sqrt(fit.information(0, 0)) / runs;
  }
  EXPECT_NEAR(errors.mean(), 0.0, 0.2 * bound);
  EXPECT_NEAR(std::sqrt(errors.squaredNorm() / runs) / bound, 1.0, 0.1);
}

TEST(InnovationLikelihood, RefusesAStepToWhereThereIsNoModel) {
  // Oracle: the maximum of the same likelihood without the hole, which is beside the first step, where the
  // differences of the second are taken.
  const filters::Measurements record = some_record(60, 4);
  Autoregression model;
  filters::InnovationProblem problem = filters::held_problem(model, record, {1}, known());
  const VectorXd begin = VectorXd::Constant(1, 0.2);
  const filters::InnovationFit whole = filters::fit_innovations(problem, begin);
  filters::InnovationSearch once;
  once.most_iterations = 1;
  const double first = filters::fit_innovations(problem, begin, once).constants[0];
  const double deviation = 1.0 / std::sqrt(whole.information(0, 0));
  ASSERT_GT(std::abs(first - whole.constants[0]), 0.02 * deviation);
  const auto everywhere = problem.model;
  int refused = 0;
  problem.model = [&](const VectorXd& theta) {
    filters::LinearGaussian form = everywhere(theta);
    if (std::abs(theta[0] - first - 0.01) < 1e-4) form.r.setConstant(-1e6), ++refused;
    return form;
  };
  const filters::InnovationFit fit = filters::fit_innovations(problem, begin);
  EXPECT_GT(refused, 0);
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.constants[0], whole.constants[0], 0.02 * deviation);
}

TEST(InnovationLikelihood, LeavesReadingsOutThatAreNotThere) {
  // Oracle: the same record cut where the reading is missing behind its end.
  filters::Measurements record = some_record(61, 4);
  record.outputs(0, 60) = std::nan("");
  const filters::Measurements shorter = some_record(60, 4);
  Autoregression model;
  const VectorXd begin = VectorXd::Constant(1, 0.5);
  const filters::InnovationFit with =
      filters::fit_innovations(filters::held_problem(model, record, {1}, known()), begin);
  const filters::InnovationFit without =
      filters::fit_innovations(filters::held_problem(model, shorter, {1}, known()), begin);
  EXPECT_NEAR(with.constants[0], without.constants[0], 1e-12);
  EXPECT_NEAR(with.cost, without.cost, 1e-12);
}

}  // namespace
}  // namespace beamid::innovation_likelihood_test
