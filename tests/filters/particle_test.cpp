// Clouds of particles: resampling, the kernel, and what a collapse looks like.
#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/known_oscillator.hpp"
#include "filters/filter_run.hpp"
#include "filters/particle_cloud.hpp"

namespace beamid::test::particle_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry, filters::ParticleCloud, filters::RandomStream;

ParticleCloud cloud(Index states, Index count, RandomStream& random) {
  VectorXd weights(count);
  for (Index i = 0; i < count; ++i) weights[i] = random.uniform();
  return {random.normal(states, count), weights / weights.sum()};
}

TEST(ParticleCloud, IsResampledSystematically) {
  // Oracle: a particle of weight w is copied floor(N w) or ceil(N w) times; sum w^2 says the effective size.
  RandomStream random(1);
  ParticleCloud before = cloud(1, 200, random), after = before;
  EXPECT_NEAR(before.effective_size(), 1.0 / before.weights.squaredNorm(), 1e-12);
  after.resample(random);
  EXPECT_EQ(after.effective_size(), 1.0 / VectorXd::Constant(200, 1.0 / 200.0).squaredNorm());
  for (Index i = 0; i < 200; ++i) {
    const auto copies = static_cast<double>((after.states.array() == before.states(0, i)).count());
    EXPECT_LT(std::abs(copies - 200.0 * before.weights[i]), 1.0);
  }
}

TEST(ParticleCloud, KeepsItsMomentsUnderTheKernel) {
  // Oracle: mean and covariance before [liu2001]; an unshrunk kernel would add a tenth to every variance.
  RandomStream random(2);
  ParticleCloud tested = cloud(3, 500, random);
  tested.weights.setConstant(1.0 / 500.0);
  const MatrixXd states = tested.states;
  const auto before = tested.moments();
  tested.regularise({0, 1, 2}, random);
  const auto after = tested.moments();
  EXPECT_LT((after.mean - before.mean).norm(), 1e-13);
  EXPECT_LT((after.covariance - before.covariance).norm(), 1e-13);
  EXPECT_GT((tested.states - states).norm(), 1.0);
}

TEST(ParticleCloud, MovesTheEntriesAskedForOnly) {
  RandomStream random(2);
  ParticleCloud tested = cloud(3, 100, random);
  tested.weights.setConstant(0.01);
  const MatrixXd states = tested.states;
  tested.regularise({1}, random);
  EXPECT_EQ(tested.states.row(0), states.row(0));
  EXPECT_EQ(tested.states.row(2), states.row(2));
  EXPECT_NE(tested.states.row(1), states.row(1));
}

// A free decay filtered by particles; K and C over their truth.
filters::FilterRun identified(const filters::Options& options, unsigned seed = 3) {
  std::mt19937 random(seed);
  const auto record = decay(1, 750, 4e-3, 1e-4, random);
  const Eigen::Vector4d mean(0.0121, 0.001, 500.0, 8.5), deviation(2e-4, 2e-3, 15.0, 1.0);
  const auto filter = filter_registry().make("particle", options, joint_model(1, 4e-3, 1e-4));
  return run(*filter, {mean, MatrixXd(deviation.cwiseAbs2().asDiagonal())}, record);
}

TEST(Particle, IdentifiesConstantsByMeansOfTheKernel) {
  // Oracle: the truth, within five deviations, and the extended filter's deviations, within a fifth.
  const auto found = identified({});
  ASSERT_FALSE(found.failure);
  const VectorXd deviation = found.last.deviations();
  EXPECT_NEAR(found.last.mean[2], stiffness, 5.0 * deviation[2]);
  EXPECT_NEAR(found.last.mean[3], damping, 5.0 * deviation[3]);
  std::mt19937 random(3);
  const auto record = decay(1, 750, 4e-3, 1e-4, random);
  const Eigen::Vector4d mean(0.0121, 0.001, 500.0, 8.5), variance(4e-8, 4e-6, 225.0, 1.0);
  const auto ekf = filter_registry().make("ekf", {}, joint_model(1, 4e-3, 1e-4));
  const auto expected = run(*ekf, {mean, MatrixXd(variance.asDiagonal())}, record).last.deviations();
  EXPECT_NEAR(deviation[2] / expected[2], 1.0, 0.2);
  EXPECT_NEAR(deviation[3] / expected[3], 1.0, 0.2);
}

TEST(Particle, CollapsesWithoutTheKernelAndSaysSo) {
  const auto found = identified({{"regularise", false}});
  EXPECT_LT(found.last.deviations()[2], 1e-6);  // all are copies of one
  ASSERT_GE(found.remarks.size(), 2u);
  EXPECT_NE(found.remarks[1].find("have become copies of"), std::string::npos) << found.remarks[1];
}

TEST(Particle, GivesTheSameNumbersForTheSameSeedOnly) {
  const auto first = identified({{"particles", 200.0}}), again = identified({{"particles", 200.0}});
  const auto other = identified({{"particles", 200.0}, {"seed", 2.0}});
  EXPECT_EQ(first.last.mean, again.last.mean);
  EXPECT_NE(first.last.mean, other.last.mean);
  EXPECT_NE(first.remarks[0].find("effective sample size: "), std::string::npos);
}

TEST(Particle, RefusesOptionsThatMeanNothing) {
  const auto make = [](const filters::Options& options) {
    return filter_registry().make("particle", options, joint_model(1, 1e-3, 1.0));
  };
  EXPECT_THROW(make({{"particles", 1.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"particles", std::nan("")}}), std::invalid_argument);
  EXPECT_THROW(make({{"resample_below", 0.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"resample_below", 1.1}}), std::invalid_argument);
  EXPECT_THROW(make({{"seed", 0.5}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::test::particle_test
