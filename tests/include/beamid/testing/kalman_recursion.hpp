// The posterior of a linear-Gaussian model by another algorithm than any filter's.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "beamid/testing/linear_model.hpp"

namespace beamid::test {

/// The information form, P^-1 = (A P A^T + Q)^-1 + C^T R^-1 C, on the outputs that are not NaN.
struct KalmanRecursion {
  const LinearModel& model;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  double log_likelihood = 0.0;

  void predict() {
    mean = model.a * mean;
    covariance = model.a * covariance * model.a.transpose() + model.q;
  }

  void correct(const Eigen::VectorXd& all) {
    std::vector<Eigen::Index> measured;
    for (Eigen::Index i = 0; i < all.size(); ++i)
      if (!std::isnan(all[i])) measured.push_back(i);
    if (measured.empty()) return;
    const Eigen::VectorXd y = all(measured);
    const Eigen::MatrixXd c = model.c(measured, Eigen::all), r = model.r(measured, measured);
    const Eigen::MatrixXd s = c * covariance * c.transpose() + r;
    const Eigen::VectorXd innovation = y - c * mean;
    log_likelihood -=
        0.5 * (innovation.dot(s.inverse() * innovation) + std::log((2 * std::numbers::pi * s).determinant()));
    const Eigen::MatrixXd information = covariance.inverse() + c.transpose() * r.inverse() * c;
    const Eigen::VectorXd vector = covariance.inverse() * mean + c.transpose() * r.inverse() * y;
    covariance = information.inverse();
    mean = covariance * vector;
  }
};

/// A stable model of n states and p outputs with correlated noises, drawn at random.
inline LinearModel random_model(Eigen::Index n, Eigen::Index p, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto gaussian = [&](Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }).eval();
  };
  LinearModel model;
  model.a = 0.9 / std::sqrt(static_cast<double>(n)) * gaussian(n, n);
  model.c = gaussian(p, n);
  const Eigen::MatrixXd q = gaussian(n, n), r = gaussian(p, p);
  model.q = q * q.transpose();
  model.r = r * r.transpose() + 0.1 * Eigen::MatrixXd::Identity(p, p);
  return model;
}

/// p x N standard normal readings.
inline Eigen::MatrixXd random_readings(Eigen::Index p, Eigen::Index samples, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(p, samples, [&] { return normal(random); });
}

}  // namespace beamid::test
