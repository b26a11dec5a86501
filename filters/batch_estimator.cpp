#include "filters/batch_estimator.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "filters/levenberg_marquardt.hpp"
#include "filters/output_error.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double undetermined = 1e-10;  // share of the largest singular value, as in identifiability.hpp
constexpr double rounding = 10.0 * std::numeric_limits<double>::epsilon();
constexpr double coarse_tolerance = 0.1;  // of part of the record: no more than the next guess

struct Descent {
  BatchStatus status = BatchStatus::iterations_exhausted;
  VectorXd coefficients;
  OutputErrorPass last;
  std::vector<double> costs;
  int passes = 0;
};

// Minimises |A x - q|^2 + damping |x|^2; entries that A and the damping leave free remain zero.
VectorXd damped_solution(const MatrixXd& a, const VectorXd& q, double damping) {
  const Index r = a.cols();
  MatrixXd rows = MatrixXd::Zero(damping > 0.0 ? 2 * r : r, r);
  VectorXd right = VectorXd::Zero(rows.rows());
  rows.topRows(r) = a;
  right.head(r) = q;
  if (damping > 0.0) rows.bottomRows(r).diagonal().setConstant(std::sqrt(damping));
  Eigen::ColPivHouseholderQR<MatrixXd> decomposition;
  decomposition.setThreshold(undetermined);
  return decomposition.compute(rows).solve(right);
}

// What the sensitivities say at one point: |a x - q|^2 of the steps x, in units of the columns' lengths.
struct ScaledPass {
  MatrixXd a;
  VectorXd q, unit;
};

// @param scale lengths of the columns of R, the largest met [marquardt1963]
ScaledPass scaled_pass(const OutputErrorPass& pass, VectorXd& scale) {
  const Index r = scale.size();
  const MatrixXd root = pass.information.root();
  const VectorXd lengths = root.topLeftCorner(r, r).colwise().norm();
  scale = scale.cwiseMax(lengths);
  ScaledPass at;
  at.unit = (scale.array() > 0.0).select(scale.cwiseInverse(), 1.0);
  at.a = root.topLeftCorner(r, r) * at.unit.asDiagonal();
  at.q = root.col(r).head(r);
  return at;
}

// From c over the first `samples`.
Descent descend(OutputError& error, const VectorXd& start, Index samples, double tolerance, int most) {
  Descent result;
  result.coefficients = start;
  result.last = error.pass(start, samples);
  ++result.passes;
  if (!result.last.finite) {
    result.status = BatchStatus::failed;
    return result;
  }
  result.costs.push_back(result.last.cost);
  VectorXd scale = VectorXd::Zero(start.size());
  ScaledPass at;
  bool converged = false;
  const auto step = [&](double damping) {
    at = scaled_pass(result.last, scale);
    const VectorXd whole = damped_solution(at.a, at.q, 0.0);
    converged = (at.a * whole).norm() <= std::max(tolerance, rounding * result.last.size);
    return converged ? whole : damped_solution(at.a, at.q, damping);
  };
  const auto take = [&](const VectorXd& x) {
    const double predicted = 0.5 * (at.q.squaredNorm() - (at.q - at.a * x).squaredNorm());
    const VectorXd trial = result.coefficients + at.unit.cwiseProduct(x);
    OutputErrorPass pass;
    try {
      pass = error.pass(trial, samples);
    } catch (const std::runtime_error&) {  // no such motion: a step too far
    }
    ++result.passes;
    const double fall = pass.finite ? result.last.cost - pass.cost : -1.0;
    const bool is_last = converged || predicted < rounding * result.last.cost;  // which rounding hides
    const double unseen = is_last ? rounding * result.last.cost : 0.0;
    if (!pass.finite || !(fall > -unseen)) return TriedStep{0.0, converged || (pass.finite && is_last)};
    result.coefficients = trial;
    result.last = std::move(pass);
    result.costs.push_back(result.last.cost);
    return TriedStep{predicted > 0.0 ? fall / predicted : 1.0, converged};
  };
  MarquardtDamping rule;
  rule.first = 1e-3, rule.least_raised = 1e-6, rule.negligible = 1e-10, rule.most_steps = most - 1;
  switch (levenberg_marquardt(rule, step, take)) {
    case DescentEnd::settled:
      result.status = BatchStatus::converged;
      break;
    case DescentEnd::stuck:
      result.status = BatchStatus::stalled;
      break;
    case DescentEnd::exhausted:
      break;
  }
  return result;
}

// I^-1 of I = R^T R, from the columns scaled to length one; nothing where some combination is undetermined.
MatrixXd inverse_information(const MatrixXd& root) {
  const Index r = root.cols();
  const VectorXd lengths = root.colwise().norm();
  if (!(lengths.minCoeff() > 0.0)) return {};
  const VectorXd unit = lengths.cwiseInverse();
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(undetermined);
  qr.compute(root * unit.asDiagonal());
  if (qr.rank() < r) return {};
  MatrixXd inverse = MatrixXd::Identity(r, r);
  qr.matrixR().triangularView<Eigen::Upper>().solveInPlace(inverse);
  inverse = unit.asDiagonal() * (qr.colsPermutation() * inverse);
  MatrixXd covariance = MatrixXd::Zero(r, r);
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(inverse);
  covariance.triangularView<Eigen::StrictlyUpper>() = covariance.transpose();
  return covariance;
}

std::string words(const BatchEstimate& estimate, const OutputErrorPass& last) {
  switch (estimate.status) {
    case BatchStatus::converged:
      return {};
    case BatchStatus::undetermined:
      return "the record does not determine every coefficient";
    case BatchStatus::iterations_exhausted:
      return "not converged after " + std::to_string(estimate.passes) + " passes through the record";
    case BatchStatus::stalled:
      return "no step lowers the cost: the sensitivities do not fit the motion";
    case BatchStatus::failed:
      break;
  }
  return last.reason;
}

void check(const BatchSettings& settings, Index samples) {
  if (samples < 1) throw std::invalid_argument("the record has no samples; expected at least one");
  if (settings.max_iterations < 1)
    throw std::invalid_argument("max_iterations is " + std::to_string(settings.max_iterations) +
                                "; expected at least 1");
  if (!(settings.tolerance > 0.0))
    throw std::invalid_argument("tolerance is " + std::to_string(settings.tolerance) +
                                "; expected more than 0");
  if (settings.first_samples < 0)
    throw std::invalid_argument("first_samples is " + std::to_string(settings.first_samples) +
                                "; expected at least 0");
}

}  // namespace

BatchEstimate estimate_batch(DiscreteModel& model, const VectorXd& state0, const MatrixXd& directions,
                             const Measurements& measurements, const BatchSettings& settings) {
  OutputError error(model, state0, directions, measurements, settings.prior_factor);
  const Index samples = measurements.size(), r = directions.cols();
  check(settings, samples);
  BatchEstimate result;
  VectorXd guess = VectorXd::Zero(r);
  if (settings.first_samples > 0)
    for (Index part = settings.first_samples; part < samples; part *= 2) {
      const Descent part_way = descend(error, guess, part, coarse_tolerance, settings.max_iterations);
      guess = part_way.coefficients;
      result.passes += part_way.passes;
    }
  Descent whole = descend(error, guess, samples, settings.tolerance, settings.max_iterations + 1);
  result.status = whole.status;
  result.passes += whole.passes;
  result.coefficients = std::move(whole.coefficients);
  result.state = error.state(result.coefficients);
  result.costs = std::move(whole.costs);
  result.information = InformationFactor(r);
  result.residuals = whole.last.residuals;
  result.measured = whole.last.measured;
  result.log_likelihood = whole.last.log_likelihood;
  if (whole.last.finite) {
    const MatrixXd root = whole.last.information.root().topLeftCorner(r, r);
    result.information.add(root);
    result.covariance = inverse_information(root);
    if (result.status == BatchStatus::converged && result.covariance.size() == 0)
      result.status = BatchStatus::undetermined;
  }
  result.reason = words(result, whole.last);
  return result;
}

}  // namespace beamid::filters
