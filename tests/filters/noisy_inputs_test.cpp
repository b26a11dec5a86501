// Inputs that were measured with noise, as part of the state.
#include "filters/latent_inputs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <memory>
#include <random>

#include "filters/filter.hpp"
#include "filters/filter_run.hpp"

namespace beamid::noisy_inputs_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// z+ = A z + B u, y = C z + D u + v, with two inputs, one of which the outputs show.
class Driven final : public filters::DiscreteModel {
 public:
  const MatrixXd a = (MatrixXd(2, 2) << 1.0, 0.1, -0.2, 0.98).finished(),
                 b = (MatrixXd(2, 2) << 0.0, 0.02, 0.1, 0.05).finished(),
                 c = (MatrixXd(2, 2) << 1.0, 0.0, -2.0, -0.2).finished(),
                 d = (MatrixXd(2, 2) << 0.0, 0.0, 1.0, 0.0).finished();

  Index inputs() const { return 2; }
  std::vector<filters::Label> state_labels() const override { return std::vector<filters::Label>(2); }
  std::vector<filters::Label> output_labels() const override { return std::vector<filters::Label>(2); }
  const MatrixXd& process_noise() const override { return none_; }
  const MatrixXd& output_noise() const override { return r_; }
  double interval() const override { return 1.0; }
  void set_interval(double) override {}
  void transition(const VectorXd& z, const VectorXd& u, VectorXd& next) override { next = a * z + b * u; }
  void linearised_transition(const VectorXd& z, const VectorXd& u, VectorXd& next,
                             MatrixXd& jacobian) override {
    next = a * z + b * u;
    jacobian = a;
  }
  void output(const VectorXd& z, const VectorXd& u, VectorXd& y) override { y = c * z + d * u; }
  void output_jacobian(const VectorXd&, const VectorXd&, MatrixXd& jacobian) override { jacobian = c; }

 private:
  MatrixXd none_, r_ = (MatrixXd(2, 2) << 0.04, 0.0, 0.0, 0.09).finished();
};

const Eigen::Vector2d noise(0.5, 0.3);

filters::Measurements some_record(Index samples) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  filters::Measurements record{VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1)),
                               MatrixXd(2, samples), MatrixXd(2, samples)};
  for (double& value : record.outputs.reshaped()) value = normal(random);
  for (double& value : record.inputs.reshaped()) value = normal(random);
  return record;
}

TEST(NoisyInputs, GiveTheConditionalMeanOfAllReadingsTogether) {
  // Oracle: the Gaussian of [z_0, e_0 .. e_N-1] conditioned on all outputs at once.
  const Index samples = 7;
  const filters::Measurements record = some_record(samples);
  const Driven plain;
  const MatrixXd prior = (MatrixXd(2, 2) << 2.0, 0.3, 0.3, 1.0).finished();
  MatrixXd reach(2, 2 + 2 * samples);  // z_k from [z_0, e]
  reach.setZero();
  reach.leftCols(2).setIdentity();
  VectorXd known = VectorXd::Zero(2);
  MatrixXd rows(2 * samples, reach.cols()), r = MatrixXd::Zero(2 * samples, 2 * samples);
  VectorXd rest(2 * samples);
  MatrixXd last = reach;
  VectorXd last_known = known;
  for (Index k = 0; k < samples; ++k) {
    last = reach, last_known = known;
    MatrixXd error = MatrixXd::Zero(2, reach.cols());
    error.block(0, 2 + 2 * k, 2, 2).setIdentity();
    const VectorXd u = record.inputs.col(k);
    rows.middleRows(2 * k, 2) = plain.c * reach - plain.d * error;
    rest.segment(2 * k, 2) = record.outputs.col(k) - plain.c * known - plain.d * u;
    r.block(2 * k, 2 * k, 2, 2) = plain.output_noise();
    reach = (plain.a * reach - plain.b * error).eval();
    known = (plain.a * known + plain.b * u).eval();
  }
  MatrixXd all = MatrixXd::Zero(reach.cols(), reach.cols());
  all.topLeftCorner(2, 2) = prior;
  for (Index k = 0; k < samples; ++k) all.block(2 + 2 * k, 2 + 2 * k, 2, 2) = noise.cwiseAbs2().asDiagonal();
  const MatrixXd gain = all * rows.transpose() * (rows * all * rows.transpose() + r).inverse();
  const VectorXd mean = last_known + last * gain * rest;
  const MatrixXd covariance = last * (all - gain * rows * all) * last.transpose();

  auto model = std::make_unique<filters::NoisyInputs>(std::make_unique<Driven>(), noise);
  const filters::NoisyInputs& noisy = *model;
  const filters::Gaussian start = noisy.with_errors({VectorXd::Zero(2), prior, {}});
  const auto filter = filters::filter_registry().make("ekf", {}, std::move(model));
  const filters::Gaussian found = noisy.without_errors(filters::run(*filter, start, record).last);
  EXPECT_LT((found.mean - mean).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((found.covariance - covariance).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(NoisyInputs, OfNoNoiseChangeNothing) {
  const filters::Measurements record = some_record(20);
  const filters::Gaussian start{VectorXd::Zero(2), MatrixXd::Identity(2, 2), {}};
  const auto plain = filters::filter_registry().make("ekf", {}, std::make_unique<Driven>());
  auto model = std::make_unique<filters::NoisyInputs>(std::make_unique<Driven>(), VectorXd::Zero(2));
  const filters::NoisyInputs& noisy = *model;
  const auto filter = filters::filter_registry().make("ekf", {}, std::move(model));
  const filters::Gaussian exact = filters::run(*plain, start, record).last,
                          found = noisy.without_errors(
                              filters::run(*filter, noisy.with_errors(start), record).last);
  EXPECT_LT((found.mean - exact.mean).norm(), 1e-14);
  EXPECT_LT((found.covariance - exact.covariance).norm(), 1e-14);
}

TEST(NoisyInputs, RefuseANegativeDeviation) {
  EXPECT_THROW(filters::NoisyInputs(std::make_unique<Driven>(), Eigen::Vector2d(0.1, -0.1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamid::noisy_inputs_test
