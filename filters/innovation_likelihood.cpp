#include "filters/innovation_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <Eigen/Cholesky>

#include "filters/batch_avx2.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::filters {
namespace {

using algorithms::InnovationGroup, Eigen::Index, Eigen::MatrixXd;

void run_side_by_side(InnovationGroup& group) {
  if (algorithms::avx2_is_usable()) return algorithms::run_innovations_avx2(group);
  algorithms::run_innovations<2, algorithms::Baseline>(group);
}

InnovationGroup::Lane lane_of(const LinearGaussian& model, InnovationPass& pass) {
  return {model.a.data(),
          model.g.data(),
          model.h.data(),
          model.d.data(),
          model.q.data(),
          model.r.data(),
          model.start.mean.data(),
          model.start.covariance.data(),
          pass.innovations.data(),
          pass.covariances.size() > 0 ? pass.covariances.data() : nullptr,
          0.0,
          1.0,
          0,
          false};
}

void take(const InnovationGroup::Lane& lane, InnovationPass& pass) {
  pass.squares = lane.sum_of_squares;
  pass.log_determinants = std::log(lane.mantissa) + static_cast<double>(lane.exponent) * std::numbers::ln2;
  pass.failed = lane.failed || !std::isfinite(pass.cost());
}

}  // namespace

std::vector<InnovationPass> innovation_passes(const std::vector<LinearGaussian>& models,
                                              const Measurements& record, double interval, bool covariances) {
  require_even_stamps(record, interval);
  const Index n = models.front().a.rows(), m = models.front().g.cols(), p = record.outputs.rows(),
              samples = record.size();
  const std::size_t lanes = algorithms::avx2_is_usable() ? 4 : 2;
  std::vector<std::int64_t> seen(static_cast<std::size_t>(2 * p));
  constexpr std::size_t boundary = 32;  // bytes
  std::vector<double> numbers(lanes * static_cast<std::size_t>(algorithms::innovation_room(n, m, p)) +
                              boundary / sizeof(double));
  void* room = numbers.data();
  std::size_t size = numbers.size() * sizeof(double);
  std::align(boundary, 1, room, size);
  std::vector<InnovationPass> passes(models.size());
  for (InnovationPass& pass : passes) {
    pass.innovations = MatrixXd::Constant(p, samples, std::nan(""));
    if (covariances) pass.covariances.resize(p * p, samples);  // touched as far as steps differ
  }
  for (std::size_t first = 0; first < models.size(); first += lanes) {
    const std::size_t used = std::min(lanes, models.size() - first);
    std::vector<std::int64_t> step_of(static_cast<std::size_t>(samples));
    InnovationGroup group{n,
                          m,
                          p,
                          samples,
                          record.outputs.data(),
                          record.inputs.data(),
                          {},
                          step_of.data(),
                          seen.data(),
                          static_cast<double*>(room)};
    for (std::size_t lane = 0; lane < lanes; ++lane) {  // those without a model repeat the last one
      const std::size_t i = first + std::min(lane, used - 1);
      group.lanes[lane] = lane_of(models[i], passes[i]);
    }
    run_side_by_side(group);
    for (std::size_t lane = 0; lane < used; ++lane) {
      take(group.lanes[lane], passes[first + lane]);
      passes[first + lane].step_of = step_of;
    }
  }
  return passes;
}

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
  /// J but for the prior's part. @throws std::runtime_error where it is not finite
  double cost_at(const VectorXd& theta) const { return cost(passes_at({theta}, false).front()); }
  /// At several theta. @throws as cost_at()
  std::vector<InnovationPass> passes_at(const std::vector<VectorXd>& places, bool covariances) const {
    std::vector<LinearGaussian> models;
    for (const VectorXd& theta : places) models.push_back(problem_.model(theta));
    auto passes = innovation_passes(models, problem_.record, problem_.interval, covariances);
    if (std::any_of(passes.begin(), passes.end(), [](const InnovationPass& one) { return one.failed; }))
      throw std::runtime_error("the covariance of an innovation is not positive definite");
    return passes;
  }
  double cost(const InnovationPass& pass) const {
    return problem_.free_inputs ? 0.5 * pass.squares : pass.cost();
  }

 private:
  const InnovationProblem& problem_;
  MatrixXd prior_;
};

// Information at theta, and the gradient of J, from differences by these steps.
struct Slope {
  MatrixXd information;
  VectorXd gradient;
  double cost = 0.0;  // without the prior's part, as the information
};

// L^-1 of every column; by hand, since matrices of a few rows are no work for blocked solvers and their
// memory.
void whiten(const MatrixXd& root, MatrixXd& columns) {
  for (Index c = 0; c < columns.cols(); ++c)
    for (Index i = 0; i < root.rows(); ++i) {
      for (Index l = 0; l < i; ++l) columns(i, c) -= root(i, l) * columns(l, c);
      columns(i, c) /= root(i, i);
    }
}

// sum_k d_i e_k^T S_k^-1 d_j e_k, and 1/2 tr(S_k^-1 d_i S_k S_k^-1 d_j S_k) where the covariances count.
// @param passes at theta, then above and below it in every direction
MatrixXd information_of(const std::vector<InnovationPass>& passes, const VectorXd& steps, bool traces) {
  const InnovationPass& here = passes[0];
  const Index q = steps.size(), p = here.innovations.rows();
  MatrixXd information = MatrixXd::Zero(q, q), slopes(p, q), turned(p, p), products(p * p, q), root;
  std::vector<Index> seen;
  for (Index k = 0; k < here.innovations.cols(); ++k) {
    if (k == 0 ||
        here.step_of[static_cast<std::size_t>(k)] != here.step_of[static_cast<std::size_t>(k - 1)]) {
      seen.clear();
      for (Index i = 0; i < p; ++i)
        if (std::isfinite(here.innovations(i, k))) seen.push_back(i);
      root = here.covariance(k)(seen, seen).llt().matrixL();
    }
    const auto read = static_cast<Index>(seen.size());
    slopes.resize(read, q), turned.resize(read, read), products.resize(read * read, q);
    for (Index j = 0; j < q; ++j) {
      const InnovationPass &up = passes[static_cast<std::size_t>(2 * j + 1)],
                           &down = passes[static_cast<std::size_t>(2 * j + 2)];
      const double width = 2.0 * steps[j];
      for (Index i = 0; i < read; ++i)
        slopes(i, j) = (up.innovations(seen[i], k) - down.innovations(seen[i], k)) / width;
      if (!traces) continue;
      const auto above = up.covariance(k), below = down.covariance(k);
      for (Index c = 0; c < read; ++c)
        for (Index i = 0; i < read; ++i)
          turned(i, c) = (above(seen[i], seen[c]) - below(seen[i], seen[c])) / width;
      whiten(root, turned);
      turned.transposeInPlace();
      whiten(root, turned);
      products.col(j) = std::sqrt(0.5) * turned.reshaped();
    }
    whiten(root, slopes);
    information += slopes.transpose().lazyProduct(slopes);
    if (traces) information += products.transpose().lazyProduct(products);
  }
  return information;
}

Slope slope_at(const Likelihood& likelihood, const VectorXd& theta, const VectorXd& steps) {
  std::vector<VectorXd> places{theta};
  for (Index j = 0; j < theta.size(); ++j)
    for (const double step : {steps[j], -steps[j]}) {
      places.push_back(theta);
      places.back()[j] = theta[j] + step;
    }
  const std::vector<InnovationPass> passes = likelihood.passes_at(places, true);
  Slope slope{information_of(passes, steps, !likelihood.free_inputs()),
              likelihood.prior() * (theta - likelihood.first()), likelihood.cost(passes[0])};
  for (Index j = 0; j < theta.size(); ++j) {
    const auto above = static_cast<std::size_t>(2 * j + 1);
    slope.gradient[j] +=
        (likelihood.cost(passes[above]) - likelihood.cost(passes[above + 1])) / (2.0 * steps[j]);
  }
  return slope;
}

// Whether theta is within a deviation of a maximum.
bool is_at(const InnovationFit& maximum, const VectorXd& theta, const MatrixXd& prior) {
  const VectorXd off = theta - maximum.constants;
  return off.dot((maximum.information + prior) * off) < 1.0;
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

InnovationFit fit_innovations(const InnovationProblem& problem, const VectorXd& begin,
                              const InnovationSearch& search) {
  constexpr int halvings = 6;
  constexpr double close_enough = 0.02, rounding = 0.1;
  const Likelihood likelihood(problem);
  InnovationFit fit{begin, {}, likelihood.cost_at(begin) + likelihood.prior_cost(begin), false};
  const VectorXd steps = difference_steps(likelihood);
  Slope slope = slope_at(likelihood, fit.constants, steps);
  for (int i = 0; i < search.most_iterations && !fit.converged; ++i) {
    fit.information = slope.information;
    const MatrixXd curvature = slope.information + likelihood.prior();
    VectorXd step = -curvature.ldlt().solve(slope.gradient);
    const double length = std::sqrt(std::max(0.0, step.dot(curvature * step)));
    const bool last = length < close_enough;
    // Taken where J falls; and, as the next step needs it, only where the model can be had all around.
    const auto take = [&](const VectorXd& tried) {
      try {
        const VectorXd there = fit.constants + tried;
        const double cost = likelihood.cost_at(there) + likelihood.prior_cost(there);
        if (!(cost < fit.cost)) return false;
        if (!last) slope = slope_at(likelihood, there, steps);
        fit.cost = cost, fit.constants = there;
        return true;
      } catch (const std::runtime_error&) {  // beyond what the model can be: a shorter step
        return false;
      }
    };
    // Halved first, then damped: as it ends at 0.02 deviations, levenberg_marquardt() would end at other
    // digits.
    bool lower = false;
    for (int halving = 0; halving < halvings && !lower; ++halving, step *= 0.5) lower = take(step);
    for (const double damping : {0.1, 10.0, 1e3, 1e5}) {
      if (lower || last) break;
      lower = take(-solve_damped(curvature, damping, slope.gradient));
    }
    fit.converged = last || (!lower && length < rounding);
    if (!lower) break;
    if (search.known && is_at(*search.known, fit.constants, likelihood.prior())) break;
  }
  return fit;
}

double innovation_log_likelihood(const InnovationProblem& problem, const VectorXd& theta) {
  return -Likelihood(problem).cost_at(theta);
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
