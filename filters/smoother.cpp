#include "filters/smoother.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>

#include "filters/covariance_factor.hpp"
#include "filters/sample_clock.hpp"
#include "filters/sample_walk.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double dependent = 1e-12;   // deviation, in units of its own entry's, that counts as none
constexpr double negligible = 1e-14;  // the same of a column that a factor can do without

VectorXd row_scale(const MatrixXd& rows) {
  const VectorXd lengths = rows.rowwise().norm();
  return (lengths.array() > 0.0).select(lengths, 1.0);
}

// A factor of the same covariance with no more columns than its rank.
MatrixXd compressed(const MatrixXd& factor) {
  const VectorXd scale = row_scale(factor);
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(negligible);
  qr.compute((scale.cwiseInverse().asDiagonal() * factor).transpose());
  const Index rank = std::max<Index>(qr.rank(), 1);
  const MatrixXd upper = qr.matrixR().topRows(rank).template triangularView<Eigen::Upper>();
  return scale.asDiagonal() * (qr.colsPermutation() * upper.transpose());
}

struct Estimate {
  VectorXd mean;
  MatrixXd factor;

  Gaussian as(const Gaussian& like) const {
    if (like.covariance.size() > 0) return {mean, covariance_of(factor)};
    return {mean, {}, factor};
  }
};

// From the estimate about z_k+1 to that about z_k, or about what disturbed it on the way.
class BackwardStep {
 public:
  BackwardStep(const Gaussian& filtered, TransitionSpread spread, const MatrixXd& process_noise)
      : mean_(filtered.mean), next_(std::move(spread.next)) {
    const bool noisy = process_noise.size() > 0 && !process_noise.isZero(0.0);
    const MatrixXd noise = noisy ? factor_of(process_noise) : MatrixXd(mean_.size(), 0);
    const Index own = spread.moved.cols(), all = own + noise.cols();
    MatrixXd moved(mean_.size(), all);
    moved << spread.moved, noise;
    state_.setZero(mean_.size(), all);
    state_.leftCols(own) = spread.state;
    noise_.setZero(mean_.size(), all);
    noise_.rightCols(noise.cols()) = noise;
    scale_ = row_scale(moved).cwiseInverse();
    const MatrixXd scaled = scale_.asDiagonal() * moved;
    inverse_.setThreshold(dependent);
    inverse_.compute(scaled);
    free_ = MatrixXd::Identity(all, all) - inverse_.solve(scaled);
  }

  Estimate state(const Estimate& after) const {
    const Estimate shift = of(state_, after);
    return {mean_ + shift.mean, shift.factor};
  }
  Estimate noise(const Estimate& after) const { return of(noise_, after); }

 private:
  // Of columns A with the coefficients e ~ N(0, I) before z_k+1 = next + B e was known.
  Estimate of(const MatrixXd& columns, const Estimate& after) const {
    const VectorXd shift = inverse_.solve(scale_.asDiagonal() * (after.mean - next_));
    MatrixXd factor(columns.rows(), free_.cols() + after.factor.cols());
    factor << columns * free_, columns * inverse_.solve(scale_.asDiagonal() * after.factor);
    return {columns * shift, compressed(factor)};
  }

  VectorXd mean_, next_, scale_;
  MatrixXd state_, noise_, free_;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> inverse_;
};

Estimate as_factor(const Gaussian& estimate) {
  return {estimate.mean, factor_of(estimate)};
}

// The steps back along a run, each made when it is asked for: those of a record of a million samples together
// are gigabytes.
class BackwardSteps {
 public:
  BackwardSteps(const FilterRun& run, DiscreteModel& model, const Measurements& measurements,
                Smoother& smoother)
      : run_(run), model_(model), measurements_(measurements), smoother_(smoother), kept_(model) {
    if (run.filtered.empty())
      throw std::invalid_argument("the run holds no filtered estimates; expected one that keeps all");
    const auto reached = static_cast<Index>(run.filtered.size());
    if (reached > measurements.size() || run.innovations.cols() != measurements.size())
      throw std::invalid_argument("the run is of " + std::to_string(run.innovations.cols()) +
                                  " samples; expected the " + std::to_string(measurements.size()) +
                                  " of the record");
    SampleClock clock(model.interval(), measurements.time_resolution);
    clock.start(measurements.time[0]);
    for (Index k = 0; k + 1 < reached; ++k) intervals_.push_back(clock.advance(measurements.time[k + 1]));
  }

  std::size_t size() const { return intervals_.size(); }

  /// From sample k + 1 to sample k.
  BackwardStep operator[](std::size_t k) {
    model_.set_interval(intervals_[k]);
    if (measurements_.inputs.size() > 0) input_ = measurements_.inputs.col(static_cast<Index>(k));
    const Gaussian& filtered = run_.filtered[k];
    return {filtered, smoother_.spread(model_, filtered, input_), model_.process_noise()};
  }

 private:
  const FilterRun& run_;
  DiscreteModel& model_;
  const Measurements& measurements_;
  Smoother& smoother_;
  IntervalKept kept_;
  std::vector<double> intervals_;  // [s]
  VectorXd input_;
};

}  // namespace

SmootherRegistry& smoother_registry() {
  static SmootherRegistry registry("smoother");
  return registry;
}

SmoothedRun smooth(const FilterRun& run, DiscreteModel& model, const Measurements& measurements,
                   const std::string& method, const Options& options, Smooth what) {
  const auto smoother = smoother_registry().make(method, options);
  BackwardSteps steps(run, model, measurements, *smoother);
  SmoothedRun result;
  result.estimates = run.filtered;
  if (what == Smooth::states_and_noises) result.noises.resize(steps.size());
  Estimate estimate = as_factor(run.filtered.back());
  for (std::size_t k = steps.size(); k-- > 0;) {
    const BackwardStep step = steps[k];
    if (what == Smooth::states_and_noises) result.noises[k] = step.noise(estimate).as(run.filtered[k]);
    estimate = step.state(estimate);
    result.estimates[k] = estimate.as(run.filtered[k]);
  }
  return result;
}

std::vector<Gaussian> fixed_lag_smooth(const FilterRun& run, DiscreteModel& model,
                                       const Measurements& measurements, Index lag, const std::string& method,
                                       const Options& options) {
  if (lag < 0) throw std::invalid_argument("lag is " + std::to_string(lag) + "; expected at least 0");
  const auto smoother = smoother_registry().make(method, options);
  BackwardSteps made(run, model, measurements, *smoother);
  std::vector<BackwardStep> steps;  // each is taken `lag` times
  for (std::size_t k = 0; k < made.size(); ++k) steps.push_back(made[k]);
  std::vector<Gaussian> result = run.filtered;
  for (std::size_t k = 0; k < steps.size() && lag > 0; ++k) {
    const std::size_t last = std::min(k + static_cast<std::size_t>(lag), steps.size());
    Estimate estimate = as_factor(run.filtered[last]);
    for (std::size_t j = last; j-- > k;) estimate = steps[j].state(estimate);
    result[k] = estimate.as(run.filtered[k]);
  }
  return result;
}

}  // namespace beamid::filters
