#include "tests/filters/oscillator.hpp"

namespace beamid::test {

std::vector<filters::Label> Oscillator::state_labels() const {
  return {{"x", "m"}, {"v", "m/s"}, {"K", "N/m"}, {"C", "N s/m"}};
}

std::vector<filters::Label> Oscillator::output_labels() const {
  std::vector<filters::Label> labels{{"x", "m"}, {"v", "m/s"}};
  labels.resize(outputs_);
  return labels;
}

void Oscillator::motion_matrix(const Eigen::VectorXd& z, Eigen::MatrixXd& a) const {
  a.resize(2, 2);
  a << 0.0, 1.0, -z[2] / mass_, -z[3] / mass_;
}

void Oscillator::motion_matrix_derivative(const Eigen::VectorXd&, Eigen::Index j, Eigen::MatrixXd& a) const {
  a.setZero(2, 2);
  a(1, j) = -1.0 / mass_;
}

void Oscillator::input_matrix(const Eigen::VectorXd&, Eigen::MatrixXd& b) const {
  b.setZero(2, input_size());
  if (forced_) b(1, 0) = 1.0 / mass_;
}

void Oscillator::output(const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::VectorXd& y) const {
  y = z.head(outputs_);
}

void Oscillator::output_jacobian(const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& h) const {
  h.setZero(outputs_, 4);
  h.leftCols(outputs_).setIdentity();
}

}  // namespace beamid::test
