// Two filters against the joint one.
#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/known_oscillator.hpp"
#include "filters/filter_run.hpp"

namespace beamid::test::dual_ekf_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry, filters::Gaussian, filters::Options;

const Eigen::Vector4d mean(0.0121, 0.001, 500.0, 8.5), variance(4e-8, 4e-6, 225.0, 1.0);

filters::FilterRun identified(const char* name, const Options& options, double process = 0.0) {
  std::mt19937 random(13);
  const auto record = decay(2, 1000, 2e-3, 1e-4, random);
  const Eigen::Vector4d q(0.0, 1e-8, process, 1e-4 * process);
  const auto model = filters::discretise(std::make_shared<Oscillator>(mass, 2), 2e-3, "exponential",
                                         {MatrixXd(q.asDiagonal()), 1e-8 * MatrixXd::Identity(2, 2)});
  auto copy = filters::discretise(std::make_shared<Oscillator>(mass, 2), 2e-3, "exponential",
                                  {MatrixXd(q.asDiagonal()), 1e-8 * MatrixXd::Identity(2, 2)});
  const auto filter = filter_registry().make(name, options, std::move(copy));
  Gaussian initial{mean, MatrixXd(variance.asDiagonal())};
  initial.covariance(0, 2) = initial.covariance(2, 0) = 5e-4;  // a stiffness known together with a start
  return run(*filter, initial, record);
}

TEST(DualEkf, IsTheJointFilterInTwoParts) {
  // Oracle: the extended filter of the joint state; parameters constant, and wandering.
  for (const double process : {0.0, 1e-2}) {
    const Gaussian expected = identified("ekf", {}, process).last,
                   found = identified("dual_ekf", {}, process).last;
    const VectorXd deviation = expected.deviations();
    EXPECT_LT((found.mean - expected.mean).cwiseQuotient(deviation).norm(), 1e-8) << process;
    EXPECT_LT((found.deviations() - deviation).cwiseQuotient(deviation).norm(), 1e-8) << process;
  }
}

TEST(DualEkf, FindsTheConstantsOfTheModelAsItsParameters) {
  const auto found = identified("dual_ekf", {}),
             told = identified("dual_ekf", {{"parameters", std::vector<double>{3.0, 2.0}}});
  ASSERT_EQ(found.remarks.size(), 1u);
  EXPECT_EQ(found.remarks[0], "parameters apart from the states: K, C");
  EXPECT_EQ(told.remarks[0], found.remarks[0]);
  EXPECT_LT((told.last.mean - found.last.mean).cwiseQuotient(found.last.deviations()).norm(), 1e-8);
}

TEST(DualEkf, LosesTheParametersWhereTheStatesDoNotFollowThem) {
  // Known of the filter as published: what the states learnt under earlier parameters is never corrected. Its
  // error is many of the deviations it tells.
  const auto found = identified("dual_ekf", {{"coupled", false}}), joint = identified("ekf", {});
  EXPECT_GT(std::abs(found.last.mean[2] - stiffness), 3.0 * std::abs(joint.last.mean[2] - stiffness));
  EXPECT_EQ(found.last.covariance(0, 2), 0.0);
}

TEST(DualEkf, RefusesParametersThatDoNotExist) {
  const auto make = [](const std::vector<double>& parameters) {
    return filter_registry().make("dual_ekf", {{"parameters", parameters}}, joint_model(1, 1e-3, 1.0));
  };
  EXPECT_NO_THROW(make({0.0, 1.0, 2.0, 3.0}));
  EXPECT_THROW(make({4.0}), std::invalid_argument);
  EXPECT_THROW(make({-1.0}), std::invalid_argument);
  EXPECT_THROW(make({2.5}), std::invalid_argument);
  EXPECT_THROW(make({2.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(make({std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::test::dual_ekf_test
