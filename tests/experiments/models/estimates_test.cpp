// Oracle: the forms p = eta, p = e^eta and p = lower + (upper - lower) / (1 + e^-eta), by hand.
#include "experiments/models/estimates.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace beamid::experiments::estimates_test {
namespace {

JointModel model_with(const std::vector<Unknown>& unknowns) {
  JointModel model;
  model.unknowns = unknowns;
  for (std::size_t j = 0; j < unknowns.size(); ++j)
    model.unknown_places.push_back(static_cast<Eigen::Index>(j));
  return model;
}

const std::vector<Unknown> forms{{"plain", "N/m", 500.0, 100.0, Form::linear},
                                 {"positive", "N/m", 500.0, 100.0, Form::logarithmic},
                                 {"between", "", 0.25, 0.1, Form::bounded, 0.0, 1.0}};

TEST(Estimates, CarryIntervalsThroughTheForm) {
  const JointModel model = model_with(forms);
  const Eigen::Vector3d mean(480.0, std::log(480.0), std::log(0.3 / 0.7));
  const Eigen::Vector3d deviation(10.0, 0.02, 0.1);
  const auto found = estimates(model, {mean, deviation.cwiseAbs2().asDiagonal()});
  EXPECT_DOUBLE_EQ(found[0].value, 480.0);
  EXPECT_DOUBLE_EQ(found[0].upper_95, 480.0 + 1.959963984540054 * 10.0);
  EXPECT_NEAR(found[1].value, 480.0, 1e-10);
  EXPECT_NEAR(found[1].deviation, 480.0 * 0.02, 1e-10);
  EXPECT_NEAR(found[1].lower_95, 480.0 * std::exp(-1.959963984540054 * 0.02), 1e-10);
  EXPECT_NEAR(found[2].value, 0.3, 1e-15);
  EXPECT_NEAR(found[2].deviation, 0.3 * 0.7 * 0.1, 1e-15);  // dp/deta = p (1 - p) on the unit interval
  EXPECT_EQ(found[1].prior_value, 500.0);
}

TEST(Estimates, AreTheSameFromAFactor) {
  const JointModel model = model_with(forms);
  Eigen::MatrixXd factor(3, 2);
  factor << 3.0, 1.0, 0.01, -0.02, 0.1, 0.05;
  const Eigen::Vector3d mean(480.0, 6.0, -1.0);
  const auto dense = estimates(model, {mean, factor * factor.transpose()});
  const auto thin = estimates(model, {mean, {}, factor});
  for (int j = 0; j < 3; ++j) EXPECT_DOUBLE_EQ(thin[j].deviation, dense[j].deviation);
}

TEST(Unknown, GoesToTheStateAndBack) {
  for (const Unknown& unknown : forms) {
    const double eta = unknown.to_state(unknown.guess), step = 1e-5;
    EXPECT_NEAR(unknown.to_physical(eta), unknown.guess, 1e-14 * unknown.guess);
    const double difference =
        (unknown.to_physical(eta + step) - unknown.to_physical(eta - step)) / (2.0 * step);
    EXPECT_NEAR(unknown.slope(eta) / difference, 1.0, 1e-8) << unknown.name;
  }
}

TEST(Unknown, RefusesWhatItsFormCannotHold) {
  EXPECT_THROW(forms[1].to_state(-1.0), std::invalid_argument);
  EXPECT_THROW(forms[2].to_state(1.0), std::invalid_argument);
  EXPECT_THROW(forms[0].to_state(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::estimates_test
