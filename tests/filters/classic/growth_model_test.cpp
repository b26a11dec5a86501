// The univariate nonstationary growth model [gordon1993]:
//
//     x_k+1 = x/2 + 25 x/(1 + x^2) + 8 cos(1.2 k) + w,   y = x^2/20 + v,   w ~ N(0, 10), v ~ N(0, 1)
//
// The reading does not tell the sign: estimates have two peaks. Gaussian filters that linearise lose the
// truth.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "filters/filter_run.hpp"
#include "filters/random.hpp"
#include "tests/filters/classic/function_model.hpp"

namespace beamid::test::growth_model_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry;

std::unique_ptr<filters::DiscreteModel> growth() {
  const auto f = [](const VectorXd& z, const VectorXd& u, VectorXd& next) {
    next[0] = 0.5 * z[0] + 25.0 * z[0] / (1.0 + z[0] * z[0]) + u[0];
  };
  const auto h = [](const VectorXd& z, const VectorXd&, VectorXd& y) { y[0] = z[0] * z[0] / 20.0; };
  return std::make_unique<FunctionModel>(f, h, MatrixXd::Constant(1, 1, 10.0), MatrixXd::Ones(1, 1));
}

struct Score {
  double rms = 0.0;   // of the filtered mean's error, over records that did not fail
  double nees = 0.0;  // mean normalised error squared: 1 when consistent
  int failures = 0;
};

// 50 records of 100 samples each, the same for every filter.
Score score(const std::string& name, const filters::Options& options) {
  constexpr Index samples = 100;
  constexpr int records = 50;
  filters::RandomStream random(2011);
  Score result;
  double squares = 0.0, normalised = 0.0, count = 0.0;
  const auto model = growth();
  for (int record = 0; record < records; ++record) {
    filters::Measurements data{VectorXd::LinSpaced(samples, 0, samples - 1.0), MatrixXd(1, samples),
                               MatrixXd(1, samples)};
    VectorXd x = std::sqrt(5.0) * random.normal(1, 1), next, y, truth(samples);
    for (Index k = 0; k < samples; ++k) {
      truth[k] = x[0];
      data.inputs(0, k) = 8.0 * std::cos(1.2 * static_cast<double>(k));
      model->output(x, {}, y);
      data.outputs(0, k) = y[0] + random.normal(1, 1)(0, 0);
      model->transition(x, data.inputs.col(k), next);
      x = next + std::sqrt(10.0) * random.normal(1, 1);
    }
    const auto filter = filter_registry().make(name, options, growth());
    const auto run = filters::run(*filter, {VectorXd::Zero(1), MatrixXd::Constant(1, 1, 5.0)}, data,
                                  filters::Keep::all_estimates);
    result.failures += run.failure.has_value();
    for (std::size_t k = 0; k < run.filtered.size(); ++k) {
      const double error = run.filtered[k].mean[0] - truth[static_cast<Index>(k)];
      const double deviation = run.filtered[k].deviations()[0];
      squares += error * error;
      normalised += error * error / (deviation * deviation);
      count += 1.0;
    }
  }
  result.rms = std::sqrt(squares / count);
  result.nees = normalised / count;
  return result;
}

TEST(GrowthModel, IsFollowedByParticlesAndEnsembles) {
  // Oracle: the particle filter with five times the particles, as near to the exact posterior as one gets.
  const Score fine = score("particle", {{"particles", 5000.0}, {"seed", 9.0}});
  const Score coarse = score("particle", {{"particles", 1000.0}});
  EXPECT_NEAR(coarse.rms / fine.rms, 1.0, 0.05);
  EXPECT_NEAR(fine.nees, 1.0, 0.5);
  EXPECT_GT(coarse.nees, fine.nees);  // at rare readings a single particle is left, and its deviation is nil
  for (const char* update : {"stochastic", "transform"}) {
    const Score ensemble = score("enkf", {{"update", std::string(update)}});
    EXPECT_EQ(ensemble.failures, 0);
    EXPECT_LT(ensemble.rms, 2.0 * fine.rms) << update;
  }
}

TEST(GrowthModel, IsLostByTheExtendedKalmanFilter) {
  // Known: linearising h near zero gives deviations far too small [gordon1993]. NEES is 1 where they are
  // right.
  const Score extended = score("ekf", {}), unscented = score("ukf", {}), particle = score("particle", {});
  EXPECT_GT(extended.nees, 20.0);
  EXPECT_GT(extended.rms, 2.0 * particle.rms);
  EXPECT_LT(unscented.rms, extended.rms);
  EXPECT_LT(unscented.nees, 0.5 * extended.nees);
}

TEST(GrowthModel, StopsNoFilterInSilence) {
  // Every registered filter: numbers that are numbers, or a failure with its reason.
  for (const auto& [name, entry] : filter_registry().entries()) {
    if (entry.contracts.contains(filters::contract::linear_models_only) ||
        entry.contracts.contains(filters::contract::linear_motion_only))
      continue;
    const Score found = score(name, {});
    EXPECT_TRUE(std::isfinite(found.rms)) << name;
    EXPECT_TRUE(std::isfinite(found.nees)) << name;
  }
}

}  // namespace
}  // namespace beamid::test::growth_model_test
