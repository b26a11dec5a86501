// Constants as particles, the motion exactly.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "beamid/testing/known_oscillator.hpp"
#include "filters/filter_run.hpp"
#include "filters/linear_gaussian.hpp"

namespace beamid::test::rao_blackwellised_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry;

constexpr double dt = 0.02, noise = 2e-3;
constexpr Index samples = 60;

filters::Gaussian known() {
  return {Eigen::Vector4d(0.012, 0.0, 480.0, 10.0),
          MatrixXd(Eigen::Vector4d(1e-6, 1e-4, 2500.0, 16.0).asDiagonal()),
          {}};
}

filters::Measurements record_of(unsigned seed) {
  std::mt19937 random(seed);
  return decay(1, samples, dt, noise, random);
}

// Mean and deviation of K and C: the likelihood of the innovations on a grid of both, 8 deviations wide.
struct Grid {
  Eigen::Vector2d mean, deviation;
  double log_evidence = 0.0;
};

Grid on_grid(const filters::Measurements& record) {
  constexpr int points = 81;
  const auto model = joint_model(1, dt, noise);
  const filters::Gaussian start = known();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), squares = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector3d> all;
  double largest = -1e300;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) {
      const Eigen::Vector2d z(-4.0 + 8.0 * i / (points - 1), -4.0 + 8.0 * j / (points - 1));
      const Eigen::Vector2d theta(480.0 + 50.0 * z[0], 10.0 + 4.0 * z[1]);
      const filters::LinearGaussian form = filters::linear_gaussian(*model, {2, 3}, theta, start, 0);
      const double log = -filters::kalman_pass(form, record, dt).cost - 0.5 * z.squaredNorm();
      all.emplace_back(theta[0], theta[1], log);
      largest = std::max(largest, log);
    }
  double total = 0.0;
  for (const auto& one : all) {
    const double w = std::exp(one[2] - largest);
    total += w;
    sum += w * one.head(2);
    squares += w * one.head(2).cwiseAbs2();
  }
  Grid grid{sum / total, {}, 0.0};
  grid.deviation = (squares / total - grid.mean.cwiseAbs2()).cwiseSqrt();
  const double cell = std::pow(8.0 / (points - 1), 2) / (2.0 * 3.14159265358979);
  grid.log_evidence = largest + std::log(total * cell) -
                      0.5 * static_cast<double>(samples) * std::log(2.0 * 3.14159265358979);
  return grid;
}

filters::FilterRun filtered(const std::string& filter, double particles, unsigned seed,
                            const filters::Measurements& record) {
  const auto made = filter_registry().make(
      filter, {{"particles", particles}, {"seed", static_cast<double>(seed)}}, joint_model(1, dt, noise));
  return run(*made, known(), record);
}

TEST(RaoBlackwellised, IsTheGridsPosteriorWithinTheErrorOfItsParticles) {
  // Oracle: the posterior of K and C on a grid. Of 200 particles the mean errs by 0.07 deviations if they are
  // independent; five times that is allowed, and a quarter of the deviation.
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const filters::Measurements record = record_of(seed);
    const Grid grid = on_grid(record);
    const filters::FilterRun found = filtered("rao_blackwellised", 200, seed, record);
    ASSERT_FALSE(found.failure);
    const VectorXd deviation = found.last.deviations().tail(2);
    for (Index j = 0; j < 2; ++j) {
      EXPECT_NEAR(found.last.mean[2 + j], grid.mean[j], 0.35 * grid.deviation[j]) << seed << " " << j;
      EXPECT_NEAR(deviation[j] / grid.deviation[j], 1.0, 0.25) << seed << " " << j;
    }
    EXPECT_NEAR(found.log_likelihood, grid.log_evidence, 0.5) << seed;
  }
}

TEST(RaoBlackwellised, ErrsLessThanTenTimesAsManyParticlesOfTheWholeState) {
  // Oracle: the grid. Mean square error of K in its deviations, over eight seeds of the draws.
  const filters::Measurements record = record_of(1);
  const Grid grid = on_grid(record);
  double few = 0.0, many = 0.0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    few += std::pow(
        (filtered("rao_blackwellised", 100, seed, record).last.mean[2] - grid.mean[0]) / grid.deviation[0],
        2);
    many += std::pow(
        (filtered("particle", 1000, seed, record).last.mean[2] - grid.mean[0]) / grid.deviation[0], 2);
  }
  EXPECT_LT(few, many);
}

TEST(RaoBlackwellised, RefusesAMotionThatIsNotLinear) {
  class Pendulum final : public filters::DiscreteModel {
   public:
    std::vector<filters::Label> state_labels() const override { return {{"a", ""}, {"b", ""}}; }
    std::vector<filters::Label> output_labels() const override { return {{"a", ""}}; }
    const MatrixXd& process_noise() const override { return q_; }
    const MatrixXd& output_noise() const override { return r_; }
    double interval() const override { return 1.0; }
    void transition(const VectorXd& z, const VectorXd&, VectorXd& next) override {
      next = Eigen::Vector2d(z[0] + 0.1 * z[1], z[1] - 0.1 * std::sin(z[0]));
    }
    void output(const VectorXd& z, const VectorXd&, VectorXd& y) override { y = z.head(1); }

   private:
    MatrixXd q_ = 0.01 * MatrixXd::Identity(2, 2), r_ = MatrixXd::Identity(1, 1);
  };
  const auto filter = filter_registry().make("rao_blackwellised", {}, std::make_unique<Pendulum>());
  EXPECT_THROW(filter->reset({Eigen::Vector2d(1.0, 0.0), MatrixXd::Identity(2, 2), {}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamid::test::rao_blackwellised_test
