#include "filters/methods/conditional_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "filters/innovation.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

bool differ(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() > 1e-9 * (a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
}

}  // namespace

// Constants are entries that stay as they are, without noise. Those that the motion of the others depends
// on are held by particles.
void ConditionalMotion::reset(const Gaussian& start) {
  start_ = start;
  const Index n = start.mean.size();
  const VectorXd none, deviation = start.deviations();
  VectorXd next;
  MatrixXd moved, shown, other;
  model_.linearised_transition(start.mean, none, next, moved);
  model_.output_jacobian(start.mean, none, shown);
  const MatrixXd& q = model_.process_noise();
  std::vector<Index> constants, moving;
  for (Index i = 0; i < n; ++i) {
    VectorXd row = moved.row(i);
    row[i] -= 1.0;
    const bool stays = row.cwiseAbs().maxCoeff() < 1e-12 && (q.size() == 0 || q(i, i) == 0.0);
    (stays ? constants : moving).push_back(i);
  }
  held_.clear();
  free_ = moving;
  for (const Index i : constants) {
    VectorXd there = start.mean;
    there[i] += deviation[i] > 0.0 ? deviation[i] : 1e-3 * std::max(1.0, std::abs(there[i]));
    model_.linearised_transition(there, none, next, other);
    bool changes = differ(moved(moving, moving), other(moving, moving));
    model_.output_jacobian(there, none, other);
    changes = changes || differ(shown(Eigen::all, moving), other(Eigen::all, moving));
    (changes ? held_ : free_).push_back(i);
  }
  std::sort(free_.begin(), free_.end());
  VectorXd there = start.mean;
  there(free_) += deviation(free_);
  model_.linearised_transition(there, none, next, other);
  bool linear = !differ(moved(free_, free_), other(free_, free_));
  model_.output_jacobian(there, none, other);
  linear = linear && !differ(shown(Eigen::all, free_), other(Eigen::all, free_));
  if (!linear)
    throw std::invalid_argument(
        "rao_blackwellised: the motion is not linear where its constants are held; expected a linear one "
        "(particle, ukf or ekf take the others)");
}

void ConditionalMotion::begin(ConstantParticle& one) const {
  one.mean = start_.mean(free_);
  one.covariance = start_.covariance(free_, free_);
  one.settled = one.fresh = 0.0;
  one.interval = -1.0;
  one.h.resize(0, 0);
  if (held_.empty()) return;
  const MatrixXd across = start_.covariance(free_, held_);
  if (across.isZero(0.0)) return;
  const Eigen::LDLT<MatrixXd> known(start_.covariance(held_, held_));
  one.mean += across * known.solve(one.theta - start_.mean(held_));
  one.covariance -= across * known.solve(across.transpose());
}

VectorXd ConditionalMotion::state(const ConstantParticle& one) const {
  VectorXd result(start_.mean.size());
  result(free_) = one.mean;
  result(held_) = one.theta;
  return result;
}

void ConditionalMotion::move(ConstantParticle& one, const RecordStep& step) {
  if (one.interval != step.interval) {
    const VectorXd none = VectorXd::Zero(step.input.size());
    model_.linearised_transition(state(one), none, next_, tangent_);
    one.interval = step.interval;
    one.a = tangent_(free_, free_);
    one.c = next_(free_) - one.a * one.mean;
  }
  if (step.input.size() > 0) {
    model_.transition(state(one), step.input, next_);
    one.mean = next_(free_);
  } else {
    one.mean = (one.a * one.mean + one.c).eval();
  }
  work_.noalias() = one.a * one.covariance;
  one.covariance.noalias() = work_ * one.a.transpose();
  if (step.noise.size() > 0) one.covariance += step.noise(free_, free_);
  symmetrise(one.covariance);
}

double ConditionalMotion::correct(ConstantParticle& one, const RecordStep& step, VectorXd& expected,
                                  MatrixXd& s) {
  if (one.h.size() == 0 || one.seen != step.observed) {
    const VectorXd none = VectorXd::Zero(step.input.size()), at = state(one);
    model_.output(at, none, expected);
    model_.output_jacobian(at, none, tangent_);
    one.seen = step.observed;
    one.h = tangent_(Eigen::all, free_);
    one.d = expected - one.h * one.mean;
  }
  const MatrixXd& h = one.h;
  if (step.input.size() > 0)
    model_.output(state(one), step.input, expected);
  else
    expected = h * one.mean + one.d;
  const MatrixXd across = one.covariance * h.transpose();
  s = h * across + step.noise;
  const Eigen::LLT<MatrixXd> factor(s);
  if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  const VectorXd rest = step.output - expected;
  const MatrixXd gain = factor.solve(across.transpose()).transpose();
  one.mean += gain * rest;
  MatrixXd kept = -gain * h;
  kept.diagonal().array() += 1.0;
  one.covariance = (kept * one.covariance * kept.transpose() + gain * step.noise * gain.transpose()).eval();
  return -0.5 * (rest.dot(factor.solve(rest)) +
                 std::log(2.0 * std::numbers::pi) * static_cast<double>(rest.size())) -
         factor.matrixLLT().diagonal().array().log().sum();
}

void ConditionalMotion::replay(ConstantParticle& one, const std::vector<RecordStep>& record,
                               std::size_t settled_steps) {
  const double interval = model_.interval();
  const std::vector<Index> observed = model_.observed();
  begin(one);
  VectorXd expected;
  MatrixXd s;
  for (std::size_t k = 0; k < record.size(); ++k) {
    const RecordStep& step = record[k];
    if (step.interval != model_.interval()) model_.set_interval(step.interval);
    if (step.reading) {
      if (step.observed != model_.observed()) model_.observe(step.observed);
      (k < settled_steps ? one.settled : one.fresh) += correct(one, step, expected, s);
    } else {
      move(one, step);
    }
  }
  if (interval != model_.interval()) model_.set_interval(interval);
  if (observed != model_.observed()) model_.observe(observed);
}

}  // namespace beamid::filters
