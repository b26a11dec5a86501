#include "filters/fisher_information.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

InformationFactor::InformationFactor(Index unknowns) : rows_(MatrixXd::Zero(unknowns + block_, unknowns)) {
  if (unknowns < 1)
    throw std::invalid_argument("information about " + std::to_string(unknowns) +
                                " unknowns; expected at least 1");
}

void InformationFactor::add(const MatrixXd& whitened) {
  if (whitened.cols() != unknowns())
    throw std::invalid_argument("sensitivities to " + std::to_string(whitened.cols()) +
                                " unknowns; expected " + std::to_string(unknowns()));
  if (!whitened.allFinite()) throw std::invalid_argument("sensitivities must be finite");
  for (Index first = 0; first < whitened.rows();) {
    if (used_ == rows_.rows()) {
      rows_.topRows(unknowns()) = root();
      used_ = unknowns();
    }
    const Index count = std::min(whitened.rows() - first, rows_.rows() - used_);
    rows_.middleRows(used_, count) = whitened.middleRows(first, count);
    used_ += count;
    first += count;
  }
}

MatrixXd InformationFactor::root() const {
  const Index r = unknowns();
  MatrixXd result = MatrixXd::Zero(r, r);
  if (used_ == 0) return result;
  const Eigen::HouseholderQR<MatrixXd> qr(rows_.topRows(used_));
  const Index rank = std::min(used_, r);
  result.topRows(rank) = qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>();
  return result;
}

MatrixXd InformationFactor::information() const {
  const MatrixXd u = root();
  MatrixXd result = MatrixXd::Zero(u.cols(), u.cols());
  result.selfadjointView<Eigen::Lower>().rankUpdate(u.transpose());
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
  return result;
}

InformationFactor InformationFactor::without(const std::vector<Index>& nuisances) const {
  const Index r = unknowns();
  std::vector<bool> eliminated(static_cast<std::size_t>(r), false);
  for (const Index i : nuisances) {
    if (i < 0 || i >= r)
      throw std::invalid_argument("unknown " + std::to_string(i) + " does not exist; expected 0 to " +
                                  std::to_string(r - 1));
    eliminated[static_cast<std::size_t>(i)] = true;
  }
  std::vector<Index> kept, gone;
  for (Index i = 0; i < r; ++i) (eliminated[static_cast<std::size_t>(i)] ? gone : kept).push_back(i);
  if (kept.empty()) throw std::invalid_argument("all unknowns are to be eliminated; expected one to remain");
  if (gone.empty()) return *this;

  // What lies in the span of the nuisances' columns could be their doing; the rest is information.
  const MatrixXd u = root();
  MatrixXd span = u(Eigen::all, gone);
  for (auto column : span.colwise())
    if (const double size = column.norm(); size > 0.0) column /= size;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(span);
  const MatrixXd turned = qr.householderQ().transpose() * MatrixXd(u(Eigen::all, kept));
  InformationFactor result(static_cast<Index>(kept.size()));
  result.add(turned.bottomRows(r - qr.rank()));
  return result;
}

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
