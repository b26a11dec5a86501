#include "filters/fisher_information.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <string>

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

InformationFactor information_factor(DiscreteModel& model, const VectorXd& initial_state, Index samples,
                                     const MatrixXd& directions, const MatrixXd& inputs) {
  const auto n = static_cast<Index>(model.state_labels().size());
  if (initial_state.size() != n || directions.rows() != n)
    throw std::invalid_argument("initial state has " + std::to_string(initial_state.size()) +
                                " entries and directions have " + std::to_string(directions.rows()) +
                                " rows; expected " + std::to_string(n));
  if (inputs.size() > 0 && inputs.cols() < samples)
    throw std::invalid_argument("inputs have " + std::to_string(inputs.cols()) + " columns; expected " +
                                std::to_string(samples));
  const Eigen::LLT<MatrixXd> noise(model.output_noise());
  if (noise.info() != Eigen::Success) throw std::invalid_argument("output noise must be positive definite");
  InformationFactor result(directions.cols());
  MatrixXd moved = directions, sensor, whitened;
  VectorXd state = initial_state, next, input;
  for (Index k = 0; k < samples; ++k) {
    if (inputs.size() > 0) input = inputs.col(k);
    model.output_jacobian(state, input, sensor);
    whitened.noalias() = sensor * moved;
    noise.matrixL().solveInPlace(whitened);
    if (!whitened.allFinite())
      throw std::runtime_error("the sensitivities are not finite at sample " + std::to_string(k));
    result.add(whitened);
    if (k + 1 == samples) break;
    model.move(state, input, next, moved);
    state.swap(next);
  }
  return result;
}

MatrixXd fisher_information(DiscreteModel& model, const VectorXd& initial_state, Index samples,
                            const MatrixXd& directions, const MatrixXd& inputs) {
  return information_factor(model, initial_state, samples, directions, inputs).information();
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
