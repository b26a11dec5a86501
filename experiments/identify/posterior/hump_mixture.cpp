#include "experiments/identify/posterior/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <tbb/parallel_for.h>
#include <Eigen/Cholesky>

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

HumpMixture::HumpMixture(const std::vector<Hump>& humps) {
  double sum = 0.0;
  for (const Hump& hump : humps) {
    parts_.push_back({std::exp(hump.log_mass - humps.front().log_mass), hump.top, hump.covariance.llt()});
    sum += parts_.back().share;
  }
  for (Part& part : parts_) part.share = std::max(part.share / sum, 1e-12);
}

void HumpMixture::adapt(std::size_t hump, double share, const MatrixXd& draws, const VectorXd& weights) {
  Part& part = parts_[hump];
  part.share = std::max(share, 1e-12);
  const double sum = weights.sum();
  if (!(sum > 0.0) || sum * sum / weights.squaredNorm() < 20.0 * static_cast<double>(draws.rows() + 1))
    return;
  const VectorXd mean = draws * weights / sum;
  const MatrixXd gap = draws.colwise() - mean;
  const MatrixXd covariance = gap * weights.asDiagonal() * gap.transpose() / sum;
  const Eigen::LLT<MatrixXd> root(covariance);
  if (root.info() != Eigen::Success) return;
  part.centre = mean;
  part.root = root;
}

VectorXd HumpMixture::draw(std::size_t hump, filters::RandomStream& random) const {
  const Part& part = parts_[hump];
  const VectorXd normal = random.normal(part.centre.size(), 1);
  const double chi_square = random.normal(static_cast<Index>(freedom), 1).squaredNorm();
  return part.centre + std::sqrt(freedom / chi_square) * VectorXd(part.root.matrixL() * normal);
}

VectorXd HumpMixture::draw(filters::RandomStream& random) const {
  double sum = 0.0, place = random.uniform();
  for (const Part& part : parts_) sum += part.share;
  std::size_t hump = 0;
  for (place *= sum; hump + 1 < parts_.size() && place > parts_[hump].share; ++hump)
    place -= parts_[hump].share;
  return draw(hump, random);
}

double HumpMixture::part_log(const Part& part, const VectorXd& u) const {
  const auto q = static_cast<double>(u.size());
  const double distance = part.root.matrixL().solve(u - part.centre).squaredNorm();
  return std::lgamma(0.5 * (freedom + q)) - std::lgamma(0.5 * freedom) -
         0.5 * q * std::log(freedom * std::numbers::pi) -
         MatrixXd(part.root.matrixLLT()).diagonal().array().log().sum() -
         0.5 * (freedom + q) * std::log1p(distance / freedom);
}

double HumpMixture::log_density(const VectorXd& u) const {
  return mixed_log(u, false);
}

double HumpMixture::even_log_density(const VectorXd& u) const {
  return mixed_log(u, true);
}

double HumpMixture::mixed_log(const VectorXd& u, bool even) const {
  VectorXd logs(static_cast<Index>(parts_.size()));
  double sum = 0.0;
  for (std::size_t h = 0; h < parts_.size(); ++h) {
    const double share = even ? 1.0 : parts_[h].share;
    logs[static_cast<Index>(h)] = std::log(share) + part_log(parts_[h], u);
    sum += share;
  }
  const double largest = logs.maxCoeff();
  return largest + std::log((logs.array() - largest).exp().sum()) - std::log(sum);
}

std::size_t HumpMixture::hump(const VectorXd& u) const {
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t h = 0; h < parts_.size(); ++h)
    if (const double log = std::log(parts_[h].share) + part_log(parts_[h], u); log > most)
      most = log, best = h;
  return best;
}

namespace {

/// Draws of each part in turn, weighted: as many of each, so that a light hump is known as well as a heavy
/// one.
struct WeightedDraws {
  MatrixXd draws;               // (q x n)
  VectorXd weight;              // L N / mixture, over exp(largest)
  std::vector<std::size_t> of;  // the hump to which a draw belongs
  double largest = 0.0;
};

WeightedDraws weighted_draws(const Likelihood& likelihood, const HumpMixture& mixture, std::size_t each,
                             std::uint64_t seed, std::uint64_t round) {
  const std::size_t n = each * mixture.size();
  WeightedDraws result{MatrixXd(likelihood.size(), static_cast<Index>(n)), VectorXd(static_cast<Index>(n)),
                       std::vector<std::size_t>(n)};
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
    filters::RandomStream random(seed, (round << 32) + i);
    const VectorXd u = mixture.draw(i % mixture.size(), random);
    result.draws.col(static_cast<Index>(i)) = u;
    result.of[i] = mixture.hump(u);
    // all parts have the same number of draws here, whatever their shares
    result.weight[static_cast<Index>(i)] =
        posterior_log(likelihood.at(u, false), u) - mixture.even_log_density(u);
  });
  result.largest = result.weight.maxCoeff();
  result.weight = (result.weight.array() - result.largest).exp();
  return result;
}

}  // namespace

ImportanceSample importance_sample(const Likelihood& likelihood, HumpMixture& mixture, std::size_t draws,
                                   std::uint64_t seed) {
  ImportanceSample result;
  const std::size_t parts = mixture.size(), each = std::max<std::size_t>(draws / parts, 200);
  for (std::uint64_t round = 1; round <= 3; ++round) {
    const bool last = round == 3;
    const std::size_t number = last ? each : std::max<std::size_t>(each / 4, 200);
    const WeightedDraws sample = weighted_draws(likelihood, mixture, number, seed, round);
    result.evaluations += number * parts;
    const double sum = sample.weight.sum();
    std::vector<double> mass(parts, 0.0);
    for (std::size_t i = 0; i < sample.of.size(); ++i)
      mass[sample.of[i]] += sample.weight[static_cast<Index>(i)];
    for (double& one : mass) one /= sum;
    if (!last) {
      for (std::size_t h = 0; h < parts; ++h) {
        VectorXd own = sample.weight;
        for (std::size_t i = 0; i < sample.of.size(); ++i)
          if (sample.of[i] != h) own[static_cast<Index>(i)] = 0.0;
        mixture.adapt(h, mass[h], sample.draws, own);
      }
      continue;
    }
    const auto n = static_cast<double>(sample.of.size());
    result.share = mass;
    result.log_evidence = sample.largest + std::log(sum / n);
    // each part's draws are independent among themselves: the variance is the sum of the parts' own
    double variance = 0.0;
    for (std::size_t h = 0; h < parts; ++h) {
      double mean = 0.0, square = 0.0;
      for (std::size_t i = h; i < sample.of.size(); i += parts) {
        const double one = sample.weight[static_cast<Index>(i)];
        mean += one;
        square += one * one;
      }
      mean /= static_cast<double>(number);
      const double spread = std::max(0.0, square / static_cast<double>(number) - mean * mean);
      variance += spread * static_cast<double>(number);
    }
    result.standard_error = std::sqrt(variance) / sum;
    result.effective_share = 1.0 / (1.0 + variance * n / (sum * sum));
  }
  return result;
}

}  // namespace beamid::experiments
