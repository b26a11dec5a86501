#include "filters/linear_gaussian.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "filters/algorithms/covariance_steps.hpp"
#include "filters/innovation.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

std::vector<Index> outputs_read(const Measurements& record, Index k) {
  std::vector<Index> seen;
  for (Index i = 0; i < record.outputs.rows(); ++i)
    if (std::isfinite(record.outputs(i, k))) seen.push_back(i);
  return seen;
}

// Whether two covariances are the same, in units of their own deviations.
bool settled(const MatrixXd& before, const MatrixXd& now) {
  constexpr double same = 1e-13;
  const VectorXd size = now.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (Index j = 0; j < now.cols(); ++j)
    for (Index i = 0; i <= j; ++i)
      if (!(std::abs(now(i, j) - before(i, j)) <= same * size[i] * size[j])) return false;
  return true;
}

KalmanStep step_at(const LinearGaussian& model, const MatrixXd& covariance, std::vector<Index> seen) {
  KalmanStep step{std::move(seen), covariance, {}, {}};
  const MatrixXd h = model.h(step.seen, Eigen::all), shown = h * covariance;
  step.innovation_covariance = shown * h.transpose() + model.r(step.seen, step.seen);
  const Eigen::LLT<MatrixXd> factor(step.innovation_covariance);
  if (factor.info() != Eigen::Success)
    throw std::runtime_error("the covariance of an innovation is not positive definite");
  step.gain = factor.solve(shown).transpose();
  return step;
}

// P of the next sample.
MatrixXd next_covariance(const LinearGaussian& model, const KalmanStep& step) {
  const MatrixXd h = model.h(step.seen, Eigen::all), r = model.r(step.seen, step.seen);
  algorithms::CovarianceSteps<double, Eigen::Dynamic, Eigen::Dynamic> steps;
  MatrixXd next = step.covariance;
  steps.reduce(step.gain, h, r, next);
  steps.carry(model.a, next);
  next += model.q;
  symmetrise(next);
  return next;
}

}  // namespace

void require_even_stamps(const Measurements& record, double interval) {
  const double slack = 1e-6 * interval + 2.0 * record.time_resolution;
  for (Index k = 0; k + 1 < record.size(); ++k)
    if (std::abs(record.time[k + 1] - record.time[k] - interval) > slack)
      throw std::invalid_argument("stamps are uneven; expected even ones");
}

LinearGaussian linear_gaussian(DiscreteModel& model, const std::vector<Index>& held, const VectorXd& theta,
                               const Gaussian& start, Index inputs) {
  std::vector<bool> is_held(static_cast<std::size_t>(start.mean.size()), false);
  for (const Index place : held) is_held[static_cast<std::size_t>(place)] = true;
  std::vector<Index> moving;
  for (std::size_t i = 0; i < is_held.size(); ++i)
    if (!is_held[i]) moving.push_back(static_cast<Index>(i));
  const auto n = static_cast<Index>(moving.size());

  VectorXd rest = VectorXd::Zero(start.mean.size()), next, output, moved, shown;
  rest(held) = theta;
  VectorXd input = VectorXd::Zero(inputs);
  MatrixXd jacobian;
  LinearGaussian form;
  model.linearised_transition(rest, input, next, jacobian);
  form.a = jacobian(moving, moving);
  model.output_jacobian(rest, input, jacobian);
  form.h = jacobian(Eigen::all, moving);
  model.output(rest, input, output);
  form.g.resize(n, inputs);
  form.d.resize(output.size(), inputs);
  for (Index i = 0; i < inputs; ++i) {  // linear in u: a unit's difference is the derivative
    input.setZero();
    input[i] = 1.0;
    model.transition(rest, input, moved);
    form.g.col(i) = (moved - next)(moving);
    model.output(rest, input, shown);
    form.d.col(i) = shown - output;
  }
  const MatrixXd& process = model.process_noise();
  form.q = process.size() > 0 ? MatrixXd(process(moving, moving)) : MatrixXd::Zero(n, n);
  form.r = model.output_noise();
  form.start = {start.mean(moving), start.covariance(moving, moving), {}};
  return form;
}

KalmanPass kalman_pass(const LinearGaussian& model, const Measurements& record, double interval) {
  require_even_stamps(record, interval);
  const Index p = record.outputs.rows(), n = model.a.rows(), samples = record.size();
  KalmanPass pass{MatrixXd(n, samples), MatrixXd::Constant(p, samples, std::nan("")), {}, {}, 0.0};
  VectorXd x = model.start.mean, residual;
  MatrixXd covariance = model.start.covariance, h;
  Eigen::LLT<MatrixXd> factor;
  double log_determinant = 0.0;
  bool steady = false;
  for (Index k = 0; k < samples; ++k) {
    std::vector<Index> seen = outputs_read(record, k);
    if (!steady || seen != pass.steps.back().seen) {
      if (steady) covariance = next_covariance(model, pass.steps.back());  // a gap ends the steady state
      steady = false;
      pass.steps.push_back(step_at(model, covariance, std::move(seen)));
      const KalmanStep& step = pass.steps.back();
      h = model.h(step.seen, Eigen::all);
      factor.compute(step.innovation_covariance);
      log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
    }
    const KalmanStep& step = pass.steps.back();
    pass.step_of.push_back(pass.steps.size() - 1);
    pass.means.col(k) = x;
    if (!step.seen.empty()) {
      residual = record.outputs.col(k)(step.seen);
      residual.noalias() -= h * x;
      if (model.d.cols() > 0) residual -= model.d(step.seen, Eigen::all) * record.inputs.col(k);
      pass.innovations.col(k)(step.seen) = residual;
      pass.cost += 0.5 * (factor.matrixL().solve(residual).squaredNorm() + log_determinant);
      x.noalias() += step.gain * residual;
    }
    if (k + 1 == samples) break;
    x = (model.a * x).eval();
    if (model.g.cols() > 0) x.noalias() += model.g * record.inputs.col(k);
    if (steady) continue;
    MatrixXd next = next_covariance(model, step);
    steady = settled(step.covariance, next);
    covariance = std::move(next);
  }
  if (!std::isfinite(pass.cost)) throw std::runtime_error("the likelihood is not finite");
  return pass;
}

SmoothedRows smoothed_rows(const LinearGaussian& model, const Measurements& record, const KalmanPass& pass,
                           const MatrixXd& rows, const MatrixXd& feed) {
  const Index samples = record.size(), n = model.a.rows();
  SmoothedRows found{MatrixXd(rows.rows(), samples), MatrixXd(rows.rows(), samples)};
  VectorXd r = VectorXd::Zero(n), weighed;
  MatrixXd w = MatrixXd::Zero(n, n), l, shown, information;
  bool steady = false;
  std::size_t known = pass.steps.size();
  Eigen::LLT<MatrixXd> factor;
  for (Index k = samples - 1; k >= 0; --k) {
    const KalmanStep& step = pass.step(k);
    const MatrixXd& p = step.covariance;
    const bool same = pass.step_of[static_cast<std::size_t>(k)] == known;
    if (!same) {
      known = pass.step_of[static_cast<std::size_t>(k)];
      const MatrixXd h = model.h(step.seen, Eigen::all);
      factor.compute(step.innovation_covariance);
      shown = factor.solve(h);  // S^-1 H
      information = h.transpose() * shown;
      l = model.a - model.a * step.gain * h;
    }
    r = (l.transpose() * r).eval();
    if (!step.seen.empty()) r.noalias() += shown.transpose() * pass.innovations.col(k)(step.seen);
    if (!same || !steady) {
      MatrixXd next = information + l.transpose() * w * l;
      next = (0.5 * (next + next.transpose())).eval();
      steady = same && settled(w, next);
      w = std::move(next);
    }
    found.means.col(k) = rows * (pass.means.col(k) + p * r);
    if (feed.cols() > 0) found.means.col(k) += feed * record.inputs.col(k);
    if (same && steady && k + 1 < samples) {
      found.deviations.col(k) = found.deviations.col(k + 1);
      continue;
    }
    const MatrixXd reach = rows * p;
    found.deviations.col(k) =
        ((reach * rows.transpose()).diagonal() - (reach * w * reach.transpose()).diagonal())
            .cwiseMax(0.0)
            .cwiseSqrt();
  }
  return found;
}

}  // namespace beamid::filters
