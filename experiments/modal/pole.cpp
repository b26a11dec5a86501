#include "experiments/modal/pole.hpp"

#include <cmath>
#include <numbers>

namespace beamid::experiments {

double Pole::frequency_hz() const {
  return std::abs(rate) / (2 * std::numbers::pi);
}

double Pole::damping_ratio() const {
  return std::abs(rate) > 0 ? -rate.real() / std::abs(rate) : 0;
}

void Pole::take_deviations(const Eigen::Matrix2d& covariance) {
  const double w_d = rate.imag(), d = -rate.real(), w = std::abs(rate);
  const Eigen::Vector2d frequency_slope = Eigen::Vector2d(w_d, d) / (2 * std::numbers::pi * w);
  const Eigen::Vector2d damping_slope = Eigen::Vector2d(-d * w_d, w_d * w_d) / (w * w * w);
  frequency_deviation_hz = std::sqrt(frequency_slope.dot(covariance * frequency_slope));
  damping_ratio_deviation = std::sqrt(damping_slope.dot(covariance * damping_slope));
}

double modal_assurance(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  const double product = a.squaredNorm() * b.squaredNorm();
  return product > 0 ? std::norm(a.dot(b)) / product : 0;
}

double phase_collinearity(const Eigen::VectorXcd& shape) {
  const double xx = shape.real().squaredNorm(), yy = shape.imag().squaredNorm(),
               xy = shape.real().dot(shape.imag()), sum = xx + yy;
  return sum > 0 ? ((xx - yy) * (xx - yy) + 4 * xy * xy) / (sum * sum) : 0;
}

}  // namespace beamid::experiments
