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

// Means, innovations and cost of a record through steps that are known.
void follow(const LinearGaussian& model, const Measurements& record, KalmanPass& pass) {
  const Index p = record.outputs.rows(), n = model.a.rows(), samples = record.size();
  pass.means.resize(n, samples);
  pass.innovations.setConstant(p, samples, std::nan(""));
  pass.cost = 0.0;
  VectorXd x = model.start.mean, residual;
  MatrixXd h;
  Eigen::LLT<MatrixXd> factor;
  double log_determinant = 0.0;
  for (Index k = 0; k < samples; ++k) {
    const KalmanStep& step = pass.step(k);
    if (k == 0 || &step != &pass.step(k - 1)) {
      h = model.h(step.seen, Eigen::all);
      factor.compute(step.innovation_covariance);
      log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
    }
    pass.means.col(k) = x;
    if (!step.seen.empty()) {
      residual = record.outputs.col(k)(step.seen);
      residual.noalias() -= h * x;
      if (model.d.cols() > 0) residual -= model.d(step.seen, Eigen::all) * record.inputs.col(k);
      pass.innovations.col(k)(step.seen) = residual;
      pass.cost += 0.5 * (factor.matrixL().solve(residual).squaredNorm() + log_determinant);
      x.noalias() += step.gain * residual;
    }
    x = (model.a * x).eval();
    if (model.g.cols() > 0) x.noalias() += model.g * record.inputs.col(k);
  }
  if (!std::isfinite(pass.cost)) throw std::runtime_error("the likelihood is not finite");
}

// What a step of the smoother is made of, backwards.
class StepBack {
 public:
  StepBack(const LinearGaussian& model, const KalmanPass& pass) : model_(model), pass_(pass) {}

  /// Whether sample k has the matrices of the sample behind it.
  bool to(Index k) {
    const bool same = k + 1 < pass_.means.cols() && &pass_.step(k) == &pass_.step(k + 1);
    if (same) return true;
    const KalmanStep& step = pass_.step(k);
    h_ = model_.h(step.seen, Eigen::all);
    shown_ = step.innovation_covariance.llt().solve(h_);
    l_ = model_.a - model_.a * step.gain * h_;
    return false;
  }
  const MatrixXd& shown() const { return shown_; }  // S^-1 H (p' x n)
  const MatrixXd& l() const { return l_; }          // A (I - K H) (n x n)

 private:
  const LinearGaussian& model_;
  const KalmanPass& pass_;
  MatrixXd h_, shown_, l_;
};

// F with P = F F^T, of a covariance that may be singular.
MatrixXd root_of(const MatrixXd& covariance) {
  const Eigen::LDLT<MatrixXd> factor(covariance);
  const VectorXd size = factor.vectorD().cwiseMax(0.0).cwiseSqrt();
  return factor.transpositionsP().transpose() * MatrixXd(MatrixXd(factor.matrixL()) * size.asDiagonal());
}

// What later readings say of a state, Y (n x n), backwards: with Q = L L^T and Y of the sample behind,
//
//     Y_k = H^T R^-1 H + A^T (Y^-1 + Q)^-1 A,    (Y^-1 + Q)^-1 = (I - K L^T) Y (I - K L^T)^T + K K^T,
//     K = Y L (I + L^T Y L)^-1
class LaterInformation {
 public:
  explicit LaterInformation(const LinearGaussian& model)
      : model_(model), noise_(root_of(model.q)), y_(MatrixXd::Zero(model.a.rows(), model.a.rows())) {}

  /// Of sample k, whose readings it takes in. @returns whether it is the same as of the sample behind
  bool step(const KalmanStep& at) {
    const Index n = y_.rows();
    const MatrixXd shown = y_ * noise_;
    const MatrixXd k = (MatrixXd::Identity(noise_.cols(), noise_.cols()) + noise_.transpose() * shown)
                           .llt()
                           .solve(shown.transpose())
                           .transpose();
    const MatrixXd kept = MatrixXd::Identity(n, n) - k * noise_.transpose();
    MatrixXd next = model_.a.transpose() * (kept * y_ * kept.transpose() + k * k.transpose()) * model_.a;
    if (!at.seen.empty()) {
      constexpr double least = 1e-14;  // of what is expected of a reading, where it has no noise
      const MatrixXd h = model_.h(at.seen, Eigen::all);
      MatrixXd r = model_.r(at.seen, at.seen);
      r.diagonal() = r.diagonal().cwiseMax(least * at.innovation_covariance.diagonal());
      next += h.transpose() * r.llt().solve(h);
    }
    next = (0.5 * (next + next.transpose())).eval();
    const bool same = settled(y_, next);
    y_ = std::move(next);
    return same;
  }
  const MatrixXd& information() const { return y_; }

 private:
  const LinearGaussian& model_;
  MatrixXd noise_, y_;
};

// Of C x_k (c x N): (P_k^-1 + Y_k)^-1 = F (I + F^T Y F)^-1 F^T, where nothing cancels however little was
// known before. The same from the steady state's end on.
MatrixXd smoothed_deviations(const LinearGaussian& model, const KalmanPass& pass, const MatrixXd& rows) {
  const Index samples = pass.means.cols(), n = model.a.rows();
  MatrixXd deviations(rows.rows(), samples);
  LaterInformation later(model);
  bool steady = false;
  for (Index k = samples - 1; k >= 0; --k) {
    const bool same = k + 1 < samples && &pass.step(k) == &pass.step(k + 1);
    if (same && steady) {
      deviations.col(k) = deviations.col(k + 1);
      continue;
    }
    steady = later.step(pass.step(k)) && same;
    const MatrixXd root = root_of(pass.step(k).covariance);
    const Eigen::LLT<MatrixXd> sum(MatrixXd::Identity(n, n) + root.transpose() * later.information() * root);
    deviations.col(k) = sum.matrixL().solve((rows * root).transpose()).colwise().norm().transpose();
  }
  return deviations;
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
  KalmanPass pass;
  MatrixXd covariance = model.start.covariance;
  bool steady = false;
  for (Index k = 0; k < record.size(); ++k) {
    std::vector<Index> seen = outputs_read(record, k);
    if (!steady || seen != pass.steps.back().seen) {
      if (steady) covariance = next_covariance(model, pass.steps.back());  // a gap ends the steady state
      steady = false;
      pass.steps.push_back(step_at(model, covariance, std::move(seen)));
    }
    pass.step_of.push_back(pass.steps.size() - 1);
    if (steady) continue;
    MatrixXd next = next_covariance(model, pass.steps.back());
    steady = settled(pass.steps.back().covariance, next);
    covariance = std::move(next);
  }
  follow(model, record, pass);
  return pass;
}

KalmanPass kalman_pass(const LinearGaussian& model, const Measurements& record, const KalmanPass& like) {
  KalmanPass pass;
  pass.steps = like.steps;
  pass.step_of = like.step_of;
  follow(model, record, pass);
  return pass;
}

MatrixXd smoothed_means(const LinearGaussian& model, const Measurements& record, const KalmanPass& pass,
                        const MatrixXd& rows, const MatrixXd& feed) {
  MatrixXd means(rows.rows(), record.size());
  VectorXd r = VectorXd::Zero(model.a.rows());
  StepBack back(model, pass);
  for (Index k = record.size() - 1; k >= 0; --k) {
    const KalmanStep& step = pass.step(k);
    back.to(k);
    r = (back.l().transpose() * r).eval();
    if (!step.seen.empty()) r.noalias() += back.shown().transpose() * pass.innovations.col(k)(step.seen);
    means.col(k) = rows * (pass.means.col(k) + step.covariance * r);
    if (feed.cols() > 0) means.col(k) += feed * record.inputs.col(k);
  }
  return means;
}

SmoothedRows smoothed_rows(const LinearGaussian& model, const Measurements& record, const KalmanPass& pass,
                           const MatrixXd& rows, const MatrixXd& feed) {
  return {smoothed_means(model, record, pass, rows, feed), smoothed_deviations(model, pass, rows)};
}

}  // namespace beamid::filters
