#include "experiments/identify/model_check/explanation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/signal/chi_square_limit.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using ExplanationVerdict = Explanation::Verdict;

constexpr int most_steps = 30;
constexpr double smallest_step = 1e-6;  // of a candidate's scale
constexpr double singular = 1e-10;      // of the scaled information's eigenvalues

/// Scaled coordinates: x_q = scale_q u_q.
struct Problem {
  const ModelCheck& check;
  const ChangedFrequencies& frequencies;
  const std::vector<std::size_t>& which;
  VectorXd weight, scale, lower, upper;

  double cost(const VectorXd& left) const { return (weight.array() * left.array().square()).sum(); }
  VectorXd left(const VectorXd& u) const { return frequencies.left(which, u.cwiseProduct(scale)); }
  MatrixXd slope(const VectorXd& u) const {
    return frequencies.slope(which, u.cwiseProduct(scale)) * scale.asDiagonal();
  }
};

/// Solves on the eigenvectors that the data know; the others stay.
VectorXd step_of(const MatrixXd& information, const VectorXd& gradient) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(information);
  VectorXd result = VectorXd::Zero(gradient.size());
  for (Index i = 0; i < gradient.size(); ++i)
    if (eigen.eigenvalues()[i] > singular * eigen.eigenvalues().maxCoeff())
      result +=
          eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).dot(gradient) / eigen.eigenvalues()[i];
  return result;
}

// Gauss-Newton from u with steps that are halved, not damped: bounds hold some unknowns.
VectorXd descend(const Problem& problem, VectorXd u, std::vector<bool>& held) {
  const Index q = problem.scale.size();
  VectorXd left = problem.left(u);
  for (int k = 0; k < most_steps; ++k) {
    MatrixXd slope = problem.slope(u);
    VectorXd gradient = slope.transpose() * problem.weight.cwiseProduct(left);
    for (Index i = 0; i < q; ++i) {
      held[i] =
          (u[i] <= problem.lower[i] && gradient[i] < 0) || (u[i] >= problem.upper[i] && gradient[i] > 0);
      if (held[i]) slope.col(i).setZero(), gradient[i] = 0;
    }
    const VectorXd full = step_of(slope.transpose() * problem.weight.asDiagonal() * slope, gradient);
    const double before = problem.cost(left);
    VectorXd moved = VectorXd::Zero(q);
    for (double share = 1; share > 1e-3; share /= 2) {
      const VectorXd next = (u + share * full).cwiseMax(problem.lower).cwiseMin(problem.upper);
      const VectorXd there = problem.left(next);
      if (!(problem.cost(there) < before)) continue;
      moved = next - u, u = next, left = there;
      break;
    }
    if (moved.cwiseAbs().maxCoeff() < smallest_step) break;
  }
  return u;
}

// Every combination of no change and one half as large either way as is plausible.
std::vector<VectorXd> starts_of(const Problem& problem) {
  const Index q = problem.scale.size();
  std::vector<VectorXd> starts{VectorXd::Zero(q)};
  if (q == 1) return starts;
  for (Index i = 0; i < q; ++i) {
    const Candidate& c = problem.check.candidates[problem.which[static_cast<std::size_t>(i)]];
    for (std::size_t k = 0, known = starts.size(); k < known; ++k)
      for (const double limit : {c.plausible_lower, c.plausible_upper}) {
        if (limit == 0.0) continue;
        starts.push_back(starts[k]);
        starts.back()[i] = 0.5 * limit / problem.scale[i];
      }
  }
  return starts;
}

// Several changes together have several minima: the least of what descents from several places leave.
VectorXd solve(const Problem& problem, std::vector<bool>& held) {
  VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (const VectorXd& start : starts_of(problem)) {
    std::vector<bool> at_limit(held.size(), false);
    const VectorXd u = descend(problem, start, at_limit);
    const double cost = problem.cost(problem.left(u));
    if (best.size() > 0 && !(cost < (1.0 - 1e-6) * least)) continue;
    least = cost, best = u, held = at_limit;
  }
  return best;
}

void judge_explanation(const ModelCheck& check, Explanation& e) {
  bool known = true;
  for (std::size_t i = 0; i < e.candidates.size(); ++i) {
    const Candidate& c = check.candidates[e.candidates[i]];
    known = known && 2 * 1.96 * e.deviation[i] < c.plausible_upper - c.plausible_lower;
    e.plausible = e.plausible && e.upper_95(i) >= c.plausible_lower && e.lower_95(i) <= c.plausible_upper;
  }
  // A change held at its limit fits nothing.
  const Index freedom = e.freedom + std::count(e.at_limit.begin(), e.at_limit.end(), true);
  e.verdict = freedom > 0 && e.chi_square > chi_square_limit(static_cast<double>(freedom))
                  ? ExplanationVerdict::leaves_much
              : !known      ? ExplanationVerdict::undetermined
              : e.plausible ? ExplanationVerdict::explains
                            : ExplanationVerdict::implausible;
}

}  // namespace

VectorXd variances(const ModelCheck& check) {
  VectorXd result(static_cast<Index>(check.modes.size()));
  for (std::size_t i = 0; i < check.modes.size(); ++i) {
    const ObservedMode& mode = check.modes[i].identified;
    const double deviation = std::isfinite(mode.frequency_deviation_hz) ? mode.frequency_deviation_hz : 0;
    result[static_cast<Index>(i)] =
        std::pow(deviation / mode.frequency_hz, 2) + std::pow(check.settings.model_error, 2);
  }
  return result;
}

Explanation explain(const ModelCheck& check, const ChangedFrequencies& frequencies,
                    const std::vector<std::size_t>& which) {
  const auto q = static_cast<Index>(which.size());
  Problem problem{check,       frequencies, which,      variances(check).cwiseInverse(),
                  VectorXd(q), VectorXd(q), VectorXd(q)};
  for (Index i = 0; i < q; ++i) {
    const Candidate& c = check.candidates[which[i]];
    problem.scale[i] = c.scale, problem.lower[i] = c.lower / c.scale, problem.upper[i] = c.upper / c.scale;
  }
  Explanation result;
  result.candidates = which;
  result.at_limit.assign(which.size(), false);
  const VectorXd u = solve(problem, result.at_limit);
  result.change = u.cwiseProduct(problem.scale);
  result.left = problem.left(u);
  result.chi_square = problem.cost(result.left);
  result.freedom = result.left.size() - q;
  const MatrixXd slope = problem.slope(u);
  const MatrixXd information = slope.transpose() * problem.weight.asDiagonal() * slope;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(information);
  const MatrixXd covariance =
      eigen.eigenvectors() *
      eigen.eigenvalues().cwiseMax(singular * eigen.eigenvalues().maxCoeff()).cwiseInverse().asDiagonal() *
      eigen.eigenvectors().transpose();
  const double widened =
      result.freedom > 0 ? std::sqrt(std::max(1.0, result.chi_square / static_cast<double>(result.freedom)))
                         : 1;
  result.deviation = widened * covariance.diagonal().cwiseSqrt().cwiseProduct(problem.scale);
  if (q == 2) result.correlation = covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1));
  judge_explanation(check, result);
  return result;
}

const char* to_string(ExplanationVerdict verdict) {
  switch (verdict) {
    case ExplanationVerdict::explains:
      return "explains";
    case ExplanationVerdict::implausible:
      return "explains, but implausible";
    case ExplanationVerdict::undetermined:
      return "undetermined";
    default:
      return "does not explain";
  }
}

}  // namespace beamid::experiments
