#include "filters/innovation_likelihood.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// x+ = A x + G u, y = H x + D u at some constants, of the n entries x of the state that are not held.
struct LinearForm {
  MatrixXd a, g, h, d;
};

// Innovations of every sample, side by side.
struct Innovations {
  MatrixXd values;       // (p x N)
  MatrixXd covariances;  // S_k (p x p N)
  double cost = std::numeric_limits<double>::infinity();
};

class Likelihood {
 public:
  explicit Likelihood(const InnovationProblem& problem) : problem_(problem) {
    const Measurements& record = problem.record;
    if (!record.outputs.allFinite())
      throw std::invalid_argument("a sample was not read; expected a record without gaps");
    const double dt = problem.model.interval(), slack = 1e-6 * dt + 2.0 * record.time_resolution;
    for (Index k = 0; k + 1 < record.size(); ++k)
      if (std::abs(record.time[k + 1] - record.time[k] - dt) > slack)
        throw std::invalid_argument("stamps are uneven; expected even ones");
    std::vector<bool> held(static_cast<std::size_t>(problem.start.mean.size()), false);
    for (const Index place : problem.constants) held[static_cast<std::size_t>(place)] = true;
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) moving_.push_back(static_cast<Index>(i));
    const MatrixXd prior = problem.start.covariance(problem.constants, problem.constants);
    prior_ = prior.llt().solve(MatrixXd::Identity(prior.rows(), prior.cols()));
    first_ = problem.start.mean(problem.constants);
  }

  const MatrixXd& prior() const { return prior_; }
  const VectorXd& first() const { return first_; }

  double prior_cost(const VectorXd& theta) const {
    return 0.5 * (theta - first_).dot(prior_ * (theta - first_));
  }

  Innovations at(const VectorXd& theta) const {
    const LinearForm form = linear_form(theta);
    const Measurements& record = problem_.record;
    const Index p = record.outputs.rows(), n = form.a.rows(), samples = record.size();
    VectorXd x = problem_.start.mean(moving_);
    MatrixXd covariance = problem_.start.covariance(moving_, moving_);
    const MatrixXd& r = problem_.model.output_noise();
    const MatrixXd& process = problem_.model.process_noise();
    const MatrixXd q = process.size() > 0 ? MatrixXd(process(moving_, moving_)) : MatrixXd::Zero(n, n);
    Innovations found{MatrixXd(p, samples), MatrixXd(p, p * samples), 0.0};
    MatrixXd seen(p, n), gain(n, p), kept(n, n), work(n, n), s(p, p);
    VectorXd residual(p);
    for (Index k = 0; k < samples; ++k) {
      residual = record.outputs.col(k) - form.h * x;
      if (form.d.cols() > 0) residual.noalias() -= form.d * record.inputs.col(k);
      seen.noalias() = form.h * covariance;
      s = r;
      s.noalias() += seen * form.h.transpose();
      const Eigen::LLT<MatrixXd> factor(s);
      if (factor.info() != Eigen::Success)
        throw std::runtime_error("the covariance of an innovation is not positive definite");
      found.values.col(k) = residual;
      found.covariances.middleCols(k * p, p) = s;
      found.cost += 0.5 * residual.dot(factor.solve(residual)) +
                    MatrixXd(factor.matrixL()).diagonal().array().log().sum();
      gain = factor.solve(seen).transpose();
      x.noalias() += gain * residual;
      kept.setIdentity();
      kept.noalias() -= gain * form.h;
      work.noalias() = kept * covariance;
      covariance.noalias() = work * kept.transpose();
      work.leftCols(p).noalias() = gain * r;
      covariance.noalias() += work.leftCols(p) * gain.transpose();
      if (k + 1 == samples) break;
      x = (form.a * x).eval();
      if (form.g.cols() > 0) x.noalias() += form.g * record.inputs.col(k);
      work.noalias() = form.a * covariance;
      covariance.noalias() = work * form.a.transpose();
      covariance = (0.5 * (covariance + covariance.transpose())).eval() + q;
    }
    if (!std::isfinite(found.cost)) throw std::runtime_error("the likelihood is not finite");
    return found;
  }

  // The form at theta, by one linearisation and a step for each number that describes the inputs.
  LinearForm linear_form(const VectorXd& theta) const {
    DiscreteModel& model = problem_.model;
    VectorXd rest = VectorXd::Zero(problem_.start.mean.size()), next, output, moved;
    rest(problem_.constants) = theta;
    const Index inputs = problem_.record.inputs.rows();
    VectorXd none = VectorXd::Zero(inputs);
    MatrixXd jacobian;
    LinearForm form;
    model.linearised_transition(rest, none, next, jacobian);
    form.a = jacobian(moving_, moving_);
    model.output_jacobian(rest, none, jacobian);
    form.h = jacobian(Eigen::all, moving_);
    model.output(rest, none, output);
    form.g.resize(static_cast<Index>(moving_.size()), inputs);
    form.d.resize(output.size(), inputs);
    for (Index i = 0; i < inputs; ++i) {
      VectorXd one = none;
      one[i] = 1.0;
      model.transition(rest, one, moved);
      form.g.col(i) = (moved - next)(moving_);
      VectorXd shown;
      model.output(rest, one, shown);
      form.d.col(i) = shown - output;
    }
    return form;
  }

 private:
  const InnovationProblem& problem_;
  std::vector<Index> moving_;
  MatrixXd prior_;
  VectorXd first_;
};

// Information at theta, and the gradient of J, from differences by these steps.
struct Slope {
  MatrixXd information;
  VectorXd gradient;
};

Slope slope_at(const Likelihood& likelihood, const VectorXd& theta, const VectorXd& steps) {
  const Innovations here = likelihood.at(theta);
  const Index p = here.values.rows(), samples = here.values.cols(), q = theta.size();
  std::vector<MatrixXd> by_values, by_covariances;
  Slope slope{MatrixXd::Zero(q, q), likelihood.prior() * (theta - likelihood.first())};
  for (Index j = 0; j < q; ++j) {
    VectorXd there = theta;
    there[j] = theta[j] + steps[j];
    const Innovations above = likelihood.at(there);
    there[j] = theta[j] - steps[j];
    const Innovations below = likelihood.at(there);
    by_values.push_back((above.values - below.values) / (2.0 * steps[j]));
    by_covariances.push_back((above.covariances - below.covariances) / (2.0 * steps[j]));
    slope.gradient[j] += (above.cost - below.cost) / (2.0 * steps[j]);
  }
  MatrixXd white(p, q), squares(p * p, q), turned(p, p);
  for (Index k = 0; k < samples; ++k) {
    const Eigen::LLT<MatrixXd> factor(MatrixXd(here.covariances.middleCols(k * p, p)));
    for (Index j = 0; j < q; ++j) {
      const auto i = static_cast<std::size_t>(j);
      white.col(j) = factor.matrixL().solve(by_values[i].col(k));
      turned = factor.matrixL().solve(by_covariances[i].middleCols(k * p, p));
      turned = factor.matrixL().solve(turned.transpose().eval()).eval();
      squares.col(j) = std::sqrt(0.5) * turned.reshaped();
    }
    slope.information.noalias() += white.transpose() * white;
    slope.information.noalias() += squares.transpose() * squares;
  }
  return slope;
}

VectorXd difference_steps(const Likelihood& likelihood) {
  constexpr double part = 1e-3;  // of the deviations known beforehand
  return part * likelihood.prior().diagonal().cwiseSqrt().cwiseInverse();
}

}  // namespace

InnovationFit fit_innovations(const InnovationProblem& problem, const VectorXd& begin) {
  constexpr int most_iterations = 15, most_halvings = 6;
  constexpr double close_enough = 0.02;
  const Likelihood likelihood(problem);
  InnovationFit fit{begin, {}, likelihood.at(begin).cost + likelihood.prior_cost(begin), false};
  const VectorXd steps = difference_steps(likelihood);
  for (int i = 0; i < most_iterations && !fit.converged; ++i) {
    const Slope slope = slope_at(likelihood, fit.constants, steps);
    fit.information = slope.information;
    const MatrixXd curvature = slope.information + likelihood.prior();
    VectorXd step = -curvature.ldlt().solve(slope.gradient);
    const double length = std::sqrt(std::max(0.0, step.dot(curvature * step)));
    bool lower = false;
    for (int halving = 0; halving < most_halvings && !lower; ++halving, step *= 0.5) {
      try {
        const VectorXd there = fit.constants + step;
        const double cost = likelihood.at(there).cost + likelihood.prior_cost(there);
        if (cost < fit.cost) fit.cost = cost, fit.constants = there, lower = true;
      } catch (const std::runtime_error&) {  // beyond what the model can be: a shorter step
      }
    }
    fit.converged = length < close_enough;
    if (!lower) break;
  }
  return fit;
}

MatrixXd innovation_information(const InnovationProblem& problem, const VectorXd& constants) {
  const Likelihood likelihood(problem);
  return slope_at(likelihood, constants, difference_steps(likelihood)).information;
}

}  // namespace beamid::filters
