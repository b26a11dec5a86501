#include "tests/filters/conformance/kalman_recursion.hpp"

namespace beamid::test {

void KalmanRecursion::predict() {
  mean = model.a * mean;
  covariance = model.a * covariance * model.a.transpose() + model.q;
}

void KalmanRecursion::correct(const Eigen::VectorXd& all) {
  std::vector<Eigen::Index> seen;
  for (Eigen::Index i = 0; i < all.size(); ++i)
    if (!std::isnan(all[i])) seen.push_back(i);
  if (seen.empty()) return;
  const Eigen::VectorXd y = all(seen);
  const Eigen::MatrixXd c = model.c(seen, Eigen::all), r = model.r(seen, seen);
  const Eigen::MatrixXd s = c * covariance * c.transpose() + r;
  const Eigen::VectorXd innovation = y - c * mean;
  log_likelihood -= 0.5 * (innovation.dot(s.inverse() * innovation) + std::log((2 * M_PI * s).determinant()));
  const Eigen::MatrixXd information = covariance.inverse() + c.transpose() * r.inverse() * c;
  const Eigen::VectorXd vector = covariance.inverse() * mean + c.transpose() * r.inverse() * y;
  covariance = information.inverse();
  mean = covariance * vector;
}

LinearModel random_model(Eigen::Index n, Eigen::Index p, std::mt19937& random) {
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

Eigen::MatrixXd random_readings(Eigen::Index p, Eigen::Index samples, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(p, samples, [&] { return normal(random); });
}

}  // namespace beamid::test
