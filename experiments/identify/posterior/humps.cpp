#include "experiments/identify/posterior/humps.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double valley_depth = 0.5, smallest_share = 1e-6;
constexpr int valley_points = 24;

// The top of the hump that u is on. A step is at most 1 long.
std::optional<Hump> climbed(const Likelihood& likelihood, VectorXd u) {
  LikelihoodValue value = likelihood.at(u, true);
  if (!value.possible()) return {};
  const Index q = u.size();
  const auto second = [&]() -> MatrixXd { return value.information + MatrixXd::Identity(q, q); };
  const auto step = [&](double damping) -> VectorXd {
    VectorXd uphill = filters::solve_damped(second(), damping, value.gradient - u);
    return uphill / std::max(1.0, uphill.norm());
  };
  const auto take = [&](const VectorXd& tried) {
    if (tried.dot(second() * tried) < 1e-14) return filters::TriedStep{0.0, true};
    LikelihoodValue next = likelihood.at(u + tried, true);
    if (!next.possible() || !(posterior_log(next, u + tried) > posterior_log(value, u)))
      return filters::TriedStep{};
    u += tried;
    value = std::move(next);
    return filters::TriedStep{1.0, false};
  };
  filters::MarquardtDamping rule;
  rule.first = 1e-3, rule.most = 1e8;
  filters::levenberg_marquardt(rule, step, take);
  Hump hump{u, posterior_log(value, u), {}};
  const Eigen::LLT<MatrixXd> root(second());
  hump.covariance = root.solve(MatrixXd::Identity(q, q));
  hump.log_mass = hump.log_density + 0.5 * static_cast<double>(q) * std::log(2.0 * std::numbers::pi) -
                  MatrixXd(root.matrixLLT()).diagonal().array().log().sum();
  return hump;
}

// Squared distance in standard deviations of the narrower one along the line between them.
double hump_distance(const Hump& a, const Hump& b) {
  const VectorXd gap = a.top - b.top;
  return std::max(gap.dot(a.covariance.llt().solve(gap)), gap.dot(b.covariance.llt().solve(gap)));
}

bool valley_between(const Likelihood& likelihood, const Hump& a, const Hump& b) {
  const double floor = std::min(a.log_density, b.log_density) - valley_depth;
  for (int i = 1; i < valley_points; ++i) {
    const double share = static_cast<double>(i) / valley_points;
    const VectorXd u = (1.0 - share) * a.top + share * b.top;
    if (!(posterior_log(likelihood.at(u, false), u) > floor)) return true;
  }
  return false;
}

}  // namespace

double posterior_log(const LikelihoodValue& value, const VectorXd& u) {
  return value.log - 0.5 * u.squaredNorm() -
         0.5 * static_cast<double>(u.size()) * std::log(2.0 * std::numbers::pi);
}

std::vector<Hump> separate_humps(const Likelihood& likelihood, const MatrixXd& starts) {
  std::vector<std::optional<Hump>> found(static_cast<std::size_t>(starts.cols()));
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
    found[i] = climbed(likelihood, starts.col(static_cast<Index>(i)));
  });
  std::vector<Hump> candidates;
  for (std::optional<Hump>& one : found)
    if (one) candidates.push_back(std::move(*one));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Hump& a, const Hump& b) { return a.log_density > b.log_density; });
  std::vector<Hump> different;
  for (Hump& one : candidates)
    if (std::none_of(different.begin(), different.end(),
                     [&](const Hump& known) { return hump_distance(one, known) < 1e-2; }))
      different.push_back(std::move(one));
  std::stable_sort(different.begin(), different.end(),
                   [](const Hump& a, const Hump& b) { return a.log_mass > b.log_mass; });
  std::vector<Hump> humps;
  for (Hump& one : different)
    if ((humps.empty() || one.log_mass > humps.front().log_mass + std::log(smallest_share)) &&
        std::all_of(humps.begin(), humps.end(),
                    [&](const Hump& known) { return valley_between(likelihood, one, known); }))
      humps.push_back(std::move(one));
  return humps;
}

}  // namespace beamid::experiments
