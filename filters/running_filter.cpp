#include "filters/running_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <boost/math/distributions/chi_squared.hpp>

#include "filters/covariance_factor.hpp"
#include "filters/measurements.hpp"

namespace beamid::filters {

bool DivergenceAlarm::raised_by(double normalised_square, Eigen::Index outputs) {
  if (outputs == 0) return false;
  if (count_ == window) forget_oldest();
  squares_[next_] = normalised_square;
  outputs_[next_] = outputs;
  next_ = (next_ + 1) % window;
  ++count_;
  degrees_ += outputs;
  while (degrees_ - outputs_[oldest()] >= window) forget_oldest();
  unsettled_ += outputs;
  if (degrees_ < window) return false;

  if (in_bounds()) {
    in_bounds_ += outputs;
    if (in_bounds_ + window < settled) return false;
    set_ = true;
    raised_ = false;
    unsettled_ = 0;
    return false;
  }
  in_bounds_ = 0;
  if (raised_ || !(set_ || unsettled_ > patience)) return false;
  raised_ = true;
  set_ = false;
  unsettled_ = 0;
  return true;
}

void DivergenceAlarm::forget_oldest() {
  degrees_ -= outputs_[oldest()];
  squares_[oldest()] = 0.0;
  --count_;
}

bool DivergenceAlarm::in_bounds() {
  const auto place = static_cast<std::size_t>(degrees_ - window);
  if (place >= limits_.size()) limits_.resize(place + 1, 0.0);
  if (limits_[place] == 0.0)
    limits_[place] =
        quantile(complement(boost::math::chi_squared(static_cast<double>(degrees_)), probability));
  return squares_.sum() <= limits_[place];  // false of a NaN
}

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// The covariance times `inflation`, freed of what rounding has left below zero.
Gaussian inflated(const Gaussian& estimate) {
  Gaussian result{estimate.mean, {}, estimate.factor * std::sqrt(RunningFilter::inflation)};
  if (estimate.covariance.size() == 0) return result;
  if (estimate.factor.size() > 0) {
    result.covariance = covariance_of(result.factor);
    return result;
  }
  const VectorXd scale = estimate.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const VectorXd inverse = (scale.array() > 0.0).select(scale.cwiseInverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> correlation(
      inverse.asDiagonal() * (0.5 * (estimate.covariance + estimate.covariance.transpose())) *
      inverse.asDiagonal());
  const VectorXd roots = (RunningFilter::inflation * correlation.eigenvalues().cwiseMax(0.0)).cwiseSqrt();
  result.covariance = covariance_of(scale.asDiagonal() * correlation.eigenvectors() * roots.asDiagonal());
  return result;
}

double smallest_covariance_eigenvalue(const MatrixXd& covariance) {
  if (covariance.size() == 0 || !covariance.allFinite()) return unknown;
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(covariance, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace

RunningFilter::RunningFilter(Filter& filter, OnFailure on_failure, double resolution)
    : filter_(filter),
      on_failure_(on_failure),
      regular_(filter.model().interval()),
      clock_(regular_, resolution) {}

RunningFilter::~RunningFilter() {
  if (filter_.model().interval() != regular_) filter_.model().set_interval(regular_);
}

void RunningFilter::start(const Gaussian& estimate, Start start) {
  filter_.reset(estimate);
  first_ = true;
  interval_before_ = start == Start::one_interval_before;
  step_ = 0;
  held_.resize(0);
  alarm_.clear();
  events_.clear();
  failure_.reset();
}

void RunningFilter::resume(const SavedRun& saved) {
  start(saved.estimate);
  clock_.start(saved.time);
  first_ = false;
  step_ = saved.step;
  held_ = saved.input;
  alarm_ = saved.alarm;
}

SavedRun RunningFilter::save() const {
  return {filter_.estimate(), clock_.time(), held_, step_, alarm_};
}

bool RunningFilter::take_in(const Sample& sample) {
  check(sample);
  return move_to(sample.time) && correct(sample);
}

bool RunningFilter::move_to(double time) {
  if (failure_) return false;
  if (first_) {
    clock_.start(time);
    interval_ = interval_before_ ? regular_ : 0.0;
  } else {
    interval_ = clock_.advance(time);
  }
  first_ = false;
  if (on_failure_ != OnFailure::stop) good_ = filter_.estimate();
  const auto trouble = attempt([&] { predict(); });
  if (!trouble) return true;
  if (on_failure_ != OnFailure::inflate) return end(*trouble);
  events_.push_back(*trouble);
  const auto again = attempt([&] { restart(inflated(good_)); });
  return !again || end(*again);
}

bool RunningFilter::correct(const Sample& sample) {
  if (failure_) return false;
  check(sample);
  output_ = sample.output;
  if (on_failure_ != OnFailure::stop) drop_infinite();
  const Gaussian before = on_failure_ == OnFailure::report ? filter_.estimate() : Gaussian{};
  if (const auto trouble = attempt([&] { update(sample); })) {
    if (on_failure_ == OnFailure::stop) return end(*trouble);
    events_.push_back(*trouble);
    correction_ = {};
    const auto again = attempt([&] {
      if (on_failure_ == OnFailure::report) return reset(before);
      restart(inflated(good_));
      update(sample);
    });
    if (again && !go_on_without(*again)) return false;
  } else {
    heed_divergence();
  }
  held_ = sample.input;
  ++step_;
  return !failure_;
}

// Where even the inflated estimate cannot take the measurement: on from its prediction alone.
bool RunningFilter::go_on_without(const Failure& trouble) {
  if (on_failure_ == OnFailure::report) return end(trouble);
  events_.push_back(trouble);
  correction_ = {};
  const auto last = attempt([&] { restart(inflated(good_)); });
  return !last || end(*last);
}

void RunningFilter::predict() {
  if (interval_ == 0.0) return;
  filter_.model().set_interval(interval_);
  filter_.predict(held_);
}

// An estimate of its own that a filter refuses to start from is its failure, and not the caller's.
void RunningFilter::reset(const Gaussian& estimate) {
  try {
    filter_.reset(estimate);
  } catch (const std::invalid_argument& refusal) {
    throw FilterFailure(refusal.what(), smallest_covariance_eigenvalue(estimate.covariance));
  }
}

void RunningFilter::restart(const Gaussian& estimate) {
  reset(estimate);
  alarm_.clear();
  predict();
}

void RunningFilter::update(const Sample& sample) {
  const bool own_noise = sample.deviations.size() > 0;
  if (own_noise) filter_.model().set_output_noise(step_noise(sample.deviations));
  correction_ = filter_.correct(output_, sample.input);
  if (own_noise) filter_.model().set_output_noise(std::nullopt);
}

void RunningFilter::heed_divergence() {
  if (!alarm_.raised_by(correction_.normalised_square, correction_.innovation.size())) return;
  std::ostringstream reason;
  reason.precision(3);
  reason << "the innovations diverge: their mean normalised square over the last " << DivergenceAlarm::window
         << " outputs is " << alarm_.mean() << "; expected 1";
  events_.push_back({step_, clock_.time(), reason.str(),
                     smallest_covariance_eigenvalue(correction_.innovation_covariance)});
  if (on_failure_ != OnFailure::inflate) return;
  alarm_.clear();
  if (const auto trouble = attempt([&] { reset(inflated(filter_.estimate())); })) end(*trouble);
}

void RunningFilter::drop_infinite() {
  for (Index i = 0; i < output_.size(); ++i) {
    if (!std::isinf(output_[i])) continue;
    output_[i] = unknown;
    events_.push_back({step_, clock_.time(), "output " + std::to_string(i) + " is infinite", unknown});
  }
}

bool RunningFilter::end(Failure failure) {
  events_.push_back(failure);
  failure_ = std::move(failure);
  return false;
}

// What went wrong, if anything did.
template <class Action>
std::optional<Failure> RunningFilter::attempt(const Action& action) {
  try {
    action();
    return std::nullopt;
  } catch (const FilterFailure& trouble) {
    return Failure{step_, clock_.time(), trouble.what(), trouble.smallest_eigenvalue};
  } catch (const std::runtime_error& trouble) {  // a discretisation that cannot take the step
    return Failure{step_, clock_.time(), trouble.what(), unknown};
  }
}

void RunningFilter::check(const Sample& sample) const {
  const Index outputs = filter_.model().all_outputs();
  if (sample.output.size() != outputs)
    throw std::invalid_argument("a sample of " + std::to_string(sample.output.size()) +
                                " outputs; expected " + std::to_string(outputs));
  if (sample.deviations.size() == 0) return;
  if (sample.deviations.size() != outputs)
    throw std::invalid_argument("standard deviations of " + std::to_string(sample.deviations.size()) +
                                " outputs; expected " + std::to_string(outputs));
  for (Index i = 0; i < outputs; ++i)
    if (!std::isnan(sample.output[i]) &&
        !(sample.deviations[i] >= 0.0 && std::isfinite(sample.deviations[i])))
      throw std::invalid_argument("the standard deviation of output " + std::to_string(i) + " is " +
                                  std::to_string(sample.deviations[i]) + "; expected at least 0");
}

}  // namespace beamid::filters
