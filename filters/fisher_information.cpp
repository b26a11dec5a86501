#include "filters/fisher_information.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd fisher_information(DiscreteModel& model, const VectorXd& initial_state, Index samples) {
  const Index n = initial_state.size();
  const VectorXd no_input;
  const Eigen::LLT<MatrixXd> noise(model.output_noise());
  MatrixXd information = MatrixXd::Zero(n, n), tangent = MatrixXd::Identity(n, n), jacobian, sensor;
  VectorXd state = initial_state, next;
  for (Index k = 0; k < samples; ++k) {
    model.output_jacobian(state, no_input, sensor);
    const MatrixXd whitened = noise.matrixL().solve(sensor * tangent);
    information.noalias() += whitened.transpose() * whitened;
    model.linearised_transition(state, no_input, next, jacobian);
    state.swap(next);
    tangent = jacobian * tangent;
  }
  return information;
}

VectorXd cramer_rao_bound(const MatrixXd& information) {
  // Scaled to a unit diagonal: the entries' units differ by many orders of magnitude.
  const VectorXd scale = information.diagonal().cwiseSqrt();
  const MatrixXd scaled = scale.cwiseInverse().asDiagonal() * information * scale.cwiseInverse().asDiagonal();
  const Eigen::LLT<MatrixXd> factor(scaled);
  if (factor.info() != Eigen::Success || factor.rcond() < 1e-14)
    throw std::invalid_argument("the information is singular: the record does not determine every unknown");
  const MatrixXd inverse = factor.solve(MatrixXd::Identity(information.rows(), information.cols()));
  return inverse.diagonal().cwiseSqrt().cwiseQuotient(scale);
}

}  // namespace beamid::filters
