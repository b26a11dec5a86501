#include "filters/innovation_likelihood.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class Likelihood {
 public:
  explicit Likelihood(const InnovationProblem& problem) : problem_(problem) {
    const MatrixXd& known = problem.prior.covariance;
    prior_ = known.llt().solve(MatrixXd::Identity(known.rows(), known.cols()));
  }

  const MatrixXd& prior() const { return prior_; }
  const VectorXd& first() const { return problem_.prior.mean; }
  double prior_cost(const VectorXd& theta) const {
    return 0.5 * (theta - first()).dot(prior_ * (theta - first()));
  }
  bool free_inputs() const { return problem_.free_inputs; }
  KalmanPass at(const VectorXd& theta) const {
    KalmanPass pass =
        kalman_pass(problem_.model(theta), problem_.record, problem_.interval, KeptSteps::innovations);
    if (problem_.free_inputs) pass.cost -= log_determinants(pass);
    return pass;
  }

 private:
  const InnovationProblem& problem_;
  MatrixXd prior_;

  // 1/2 sum_k ln det S_k
  static double log_determinants(const KalmanPass& pass) {
    VectorXd of_step(static_cast<Index>(pass.steps.size()));
    for (std::size_t i = 0; i < pass.steps.size(); ++i) {
      const Eigen::LLT<MatrixXd> factor(pass.steps[i].innovation_covariance);
      of_step[static_cast<Index>(i)] = factor.matrixLLT().diagonal().array().log().sum();
    }
    double sum = 0.0;
    for (const std::size_t step : pass.step_of) sum += of_step[static_cast<Index>(step)];
    return sum;
  }
};

// Information at theta, and the gradient of J, from differences by these steps.
struct Slope {
  MatrixXd information;
  VectorXd gradient;
  double cost = 0.0;  // without the prior's part, as the information
};

Slope slope_at(const Likelihood& likelihood, const VectorXd& theta, const VectorXd& steps) {
  const KalmanPass here = likelihood.at(theta);
  const Index samples = here.innovations.cols(), q = theta.size();
  std::vector<KalmanPass> above, below;
  Slope slope{MatrixXd::Zero(q, q), likelihood.prior() * (theta - likelihood.first()), here.cost};
  for (Index j = 0; j < q; ++j) {
    VectorXd there = theta;
    there[j] = theta[j] + steps[j];
    above.push_back(likelihood.at(there));
    there[j] = theta[j] - steps[j];
    below.push_back(likelihood.at(there));
    slope.gradient[j] += (above.back().cost - below.back().cost) / (2.0 * steps[j]);
  }
  for (Index k = 0; k < samples; ++k) {
    const std::vector<Index>& seen = here.step(k).seen;
    const auto p = static_cast<Index>(seen.size());
    if (p == 0) continue;
    MatrixXd white(p, q), squares(p * p, q), turned(p, p);
    const Eigen::LLT<MatrixXd> factor(here.step(k).innovation_covariance);
    for (Index j = 0; j < q; ++j) {
      const KalmanPass &up = above[static_cast<std::size_t>(j)], &down = below[static_cast<std::size_t>(j)];
      const double width = 2.0 * steps[j];
      white.col(j) = factor.matrixL().solve(
          VectorXd(up.innovations.col(k)(seen) - down.innovations.col(k)(seen)) / width);
      if (likelihood.free_inputs()) continue;
      turned = factor.matrixL().solve(
          (up.step(k).innovation_covariance - down.step(k).innovation_covariance) / width);
      turned = factor.matrixL().solve(turned.transpose().eval()).eval();
      squares.col(j) = std::sqrt(0.5) * turned.reshaped();
    }
    slope.information.noalias() += white.transpose() * white;
    if (!likelihood.free_inputs()) slope.information.noalias() += squares.transpose() * squares;
  }
  return slope;
}

VectorXd difference_steps(const Likelihood& likelihood) {
  constexpr double part = 1e-3;  // of the deviations known beforehand
  return part * likelihood.prior().diagonal().cwiseSqrt().cwiseInverse();
}

}  // namespace

InnovationProblem held_problem(DiscreteModel& model, const Measurements& record,
                               const std::vector<Index>& held, const Gaussian& start) {
  const Index inputs = record.inputs.rows();
  return {[&model, held, start, inputs](const VectorXd& theta) {
            return linear_gaussian(model, held, theta, start, inputs);
          },
          record,
          model.interval(),
          {start.mean(held), start.covariance(held, held), {}}};
}

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
    // Halved, not damped: as it ends at 0.02 deviations, levenberg_marquardt() would end at other digits.
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

double innovation_log_likelihood(const InnovationProblem& problem, const VectorXd& theta) {
  return -Likelihood(problem).at(theta).cost;
}

InnovationSlope innovation_slope(const InnovationProblem& problem, const VectorXd& theta) {
  const Likelihood likelihood(problem);
  const Slope slope = slope_at(likelihood, theta, difference_steps(likelihood));
  return {-slope.cost, likelihood.prior() * (theta - likelihood.first()) - slope.gradient, slope.information};
}

MatrixXd innovation_information(const InnovationProblem& problem, const VectorXd& constants) {
  const Likelihood likelihood(problem);
  return slope_at(likelihood, constants, difference_steps(likelihood)).information;
}

}  // namespace beamid::filters
