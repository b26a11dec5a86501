#include "filters/continuous_model.hpp"

#include "filters/central_differences.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

void ContinuousModel::rate_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const {
  const auto f = [&](const VectorXd& z, VectorXd& value) { rate(z, input, value); };
  central_differences(f, state, state.size(), jacobian);
}

void ContinuousModel::output_jacobian(const VectorXd& state, const VectorXd& input,
                                      MatrixXd& jacobian) const {
  const auto h = [&](const VectorXd& z, VectorXd& value) { output(z, input, value); };
  central_differences(h, state, static_cast<Index>(output_labels().size()), jacobian);
}

std::unique_ptr<DiscreteModel> ContinuousModel::structured(double, const std::string&, const Noise&) const {
  return nullptr;
}

void LinearMotion::input_matrix(const VectorXd&, MatrixXd& matrix) const {
  matrix.setZero(motion_size(), input_size());
}

void LinearMotion::input_matrix_derivative(const VectorXd&, Index, MatrixXd& matrix) const {
  matrix.setZero(motion_size(), input_size());
}

void LinearMotion::rate(const VectorXd& state, const VectorXd& input, VectorXd& rate) const {
  const Index l = motion_size();
  MatrixXd matrix;
  motion_matrix(state, matrix);
  rate.setZero(state.size());
  rate.head(l) = matrix * state.head(l);
  if (input_size() > 0) {
    input_matrix(state, matrix);
    rate.head(l) += matrix * input;
  }
}

void LinearMotion::rate_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const {
  const Index l = motion_size();
  MatrixXd matrix;
  jacobian.setZero(state.size(), state.size());
  motion_matrix(state, matrix);
  jacobian.topLeftCorner(l, l) = matrix;
  for (Index j = 0; j < parameter_size(); ++j) {
    motion_matrix_derivative(state, j, matrix);
    jacobian.col(l + j).head(l) = matrix * state.head(l);
    if (input_size() > 0) {
      input_matrix_derivative(state, j, matrix);
      jacobian.col(l + j).head(l) += matrix * input;
    }
  }
}

}  // namespace beamid::filters
