// The posterior of a linear-Gaussian model by another algorithm than any filter's.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

#include "tests/filters/linear_model.hpp"

namespace beamid::test {

/// The information form, P^-1 = (A P A^T + Q)^-1 + C^T R^-1 C, on the outputs that are not NaN.
struct KalmanRecursion {
  const LinearModel& model;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  double log_likelihood = 0.0;

  void predict();
  void correct(const Eigen::VectorXd& all);
};

/// A stable model of n states and p outputs with correlated noises, drawn at random.
LinearModel random_model(Eigen::Index n, Eigen::Index p, std::mt19937& random);

/// p x N standard normal readings.
Eigen::MatrixXd random_readings(Eigen::Index p, Eigen::Index samples, std::mt19937& random);

}  // namespace beamid::test
