#include "filters/output_error.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "filters/sample_walk.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

std::string shape(const MatrixXd& matrix) {
  return std::to_string(matrix.rows()) + " x " + std::to_string(matrix.cols());
}

}  // namespace

OutputError::OutputError(DiscreteModel& model, const VectorXd& state0, const MatrixXd& directions,
                         const Measurements& measurements, const MatrixXd& prior_factor)
    : model_(model),
      state0_(state0),
      directions_(directions),
      measurements_(measurements),
      prior_(prior_factor) {
  const auto n = static_cast<Index>(model.state_labels().size());
  if (state0.size() != n || directions.rows() != n || directions.cols() < 1)
    throw std::invalid_argument("initial state has " + std::to_string(state0.size()) +
                                " entries and directions are " + shape(directions) + "; expected " +
                                std::to_string(n) + " entries and rows, and a column at least");
  if (!state0.allFinite() || !directions.allFinite())
    throw std::invalid_argument(
        "the motion to begin with is not finite: a structure whose frequencies are far from the record's?");
  if (prior_.size() > 0 && (prior_.cols() != directions.cols() || !prior_.allFinite()))
    throw std::invalid_argument("the prior factor is " + shape(prior_) + "; expected finite numbers in " +
                                std::to_string(directions.cols()) + " columns");
  check_measurements(measurements, static_cast<Index>(model.output_labels().size()));
}

OutputErrorPass OutputError::pass(const VectorXd& coefficients, Index samples) {
  const Index r = directions_.cols();
  OutputErrorPass result;
  result.information = InformationFactor(r + 1);
  result.residuals.setConstant(measurements_.outputs.rows(), samples,
                               std::numeric_limits<double>::quiet_NaN());
  MatrixXd moved = directions_;
  try {
    walk_samples(
        model_, measurements_, samples, state(coefficients), moved,
        [&](Index k, const VectorXd& at, const VectorXd& input) { take_in(k, at, input, moved, result); });
  } catch (const std::runtime_error& trouble) {  // a motion that leaves the numbers, or cannot take the step
    result.reason = trouble.what();
    return result;
  }
  if (prior_.size() > 0) {
    MatrixXd rows(prior_.rows(), r + 1);
    rows << prior_, -prior_ * coefficients;
    result.information.add(rows);
    result.cost += 0.5 * rows.col(r).squaredNorm();
  }
  result.finite = std::isfinite(result.cost);
  if (!result.finite) result.reason = "the cost is not finite";
  return result;
}

void OutputError::take_in(Index sample, const VectorXd& state, const VectorXd& input, const MatrixXd& moved,
                          OutputErrorPass& result) {
  measured_.clear();
  for (Index i = 0; i < measurements_.outputs.rows(); ++i)
    if (!std::isnan(measurements_.outputs(i, sample))) measured_.push_back(i);
  if (measured_.empty()) return;
  factorise_noise(sample);
  model_.output(state, input, output_);
  model_.output_jacobian(state, input, sensor_);
  const auto count = static_cast<Index>(measured_.size()), r = moved.cols();
  const VectorXd y = measurements_.outputs(measured_, sample), residual = y - output_(measured_);
  rows_.resize(count, r + 1);
  if (count == sensor_.rows())
    rows_.leftCols(r).noalias() = sensor_ * moved;
  else
    rows_.leftCols(r).noalias() = sensor_(measured_, Eigen::all) * moved;
  rows_.col(r) = residual;
  noise_.matrixL().solveInPlace(rows_);
  if (!rows_.allFinite())
    throw std::runtime_error("the motion or its sensitivities are not finite at sample " +
                             std::to_string(sample));
  result.information.add(rows_);
  const double square = rows_.col(r).squaredNorm();
  result.cost += 0.5 * square;
  result.log_likelihood -= 0.5 * (square + static_cast<double>(count) * std::log(2.0 * std::numbers::pi)) +
                           noise_.matrixLLT().diagonal().array().log().sum();
  result.size = std::hypot(result.size, noise_.matrixL().solve(y).norm());
  result.measured += count;
  for (Index i = 0; i < count; ++i)
    result.residuals(measured_[static_cast<std::size_t>(i)], sample) = residual[i];
}

void OutputError::factorise_noise(Index sample) {
  const bool own = measurements_.output_deviations.size() > 0;
  if (!own && measured_ == factorised_) return;
  const MatrixXd all = own ? step_noise(measurements_.output_deviations.col(sample)) : model_.output_noise();
  noise_.compute(all(measured_, measured_));
  if (noise_.info() != Eigen::Success)
    throw std::invalid_argument("output noise at sample " + std::to_string(sample) +
                                " must be positive definite");
  factorised_ = measured_;
}

}  // namespace beamid::filters
