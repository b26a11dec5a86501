// What a run does with trouble. Oracle: the contract of filters::run.
#include "filters/filter_run.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/oscillator.hpp"
#include "filters/stop_request.hpp"

namespace beamid::filter_run_test {
namespace {

using Eigen::MatrixXd;

TEST(Run, KeepsWhatItHasWhenADiscretisationCannotTakeTheStep) {
  // The first step needs a million turns of the oscillator, more than CVODES is allowed.
  const auto model = std::make_shared<test::Oscillator>(1.0);
  const auto filter = filters::filter_registry().make(
      "ekf", {}, filters::discretise(model, 1.0, "cvode", {{}, MatrixXd::Constant(1, 1, 1e-4)}));
  filters::Gaussian initial{Eigen::Vector4d(1.0, 0.0, 4e13, 0.0), 1e-2 * MatrixXd::Identity(4, 4)};
  const filters::Measurements record{Eigen::VectorXd::LinSpaced(5, 10.0, 14.0), MatrixXd::Ones(1, 5), {}};
  const filters::FilterRun run = filters::run(*filter, initial, record);
  ASSERT_TRUE(run.failure);
  EXPECT_EQ(run.failure->step, 1);
  EXPECT_EQ(run.failure->time, 11.0);
  EXPECT_NE(run.failure->reason.find("CVode"), std::string::npos) << run.failure->reason;
  EXPECT_TRUE(std::isnan(run.failure->smallest_eigenvalue));
  EXPECT_NEAR(run.last.mean[0], 1.0, 1e-12);  // the estimate after the first sample
}

TEST(Run, EndsWhereItsThreadWasAskedToStopAndOnlyThen) {
  const auto model = std::make_shared<test::Oscillator>(1.0);
  const auto filter = filters::filter_registry().make(
      "ekf", {}, filters::discretise(model, 0.1, "exponential", {{}, MatrixXd::Constant(1, 1, 1e-4)}));
  const filters::Gaussian initial{Eigen::Vector4d(1.0, 0.0, 4.0, 0.1), 1e-2 * MatrixXd::Identity(4, 4)};
  const filters::Measurements record{Eigen::VectorXd::LinSpaced(5, 0.0, 0.4), MatrixXd::Ones(1, 5), {}};
  std::atomic<bool> asked = false;
  {
    const filters::StopRequest request(asked);
    EXPECT_FALSE(filters::run(*filter, initial, record).failure);
    asked = true;
    EXPECT_THROW(filters::run(*filter, initial, record), filters::Stopped);
  }
  EXPECT_FALSE(filters::run(*filter, initial, record).failure);
}

}  // namespace
}  // namespace beamid::filter_run_test
