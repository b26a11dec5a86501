#include "filters/monte_carlo.hpp"

#include <Eigen/Cholesky>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "filters/covariance_factor.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double two_sided_95 = 1.959963984540054;  // standard deviations

void require_size(const VectorXd& values, Index size, const char* name) {
  if (values.size() != size)
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(values.size()) +
                                " entries; expected " + std::to_string(size));
}

// e^T P^-1 e, in units of the deviations.
double normalised_square(const VectorXd& error, const MatrixXd& covariance) {
  const VectorXd unit = covariance.diagonal().cwiseSqrt().cwiseInverse();
  if (!unit.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::LLT<MatrixXd> factor(unit.asDiagonal() * covariance * unit.asDiagonal());
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return factor.matrixL().solve(unit.cwiseProduct(error)).squaredNorm();
}

// Sums over the runs that are kept.
struct Tally {
  explicit Tally(Index k)
      : errors(VectorXd::Zero(k)), squares(VectorXd::Zero(k)), variances(VectorXd::Zero(k)), covered(k) {
    covered.setZero();
  }
  void add(const VectorXd& error, const MatrixXd& covariance) {
    const VectorXd variance = covariance.diagonal();
    ++runs;
    errors += error;
    squares += error.cwiseAbs2();
    variances += variance;
    covered += (error.array().abs() <= two_sided_95 * variance.array().max(0.0).sqrt()).cast<int>().matrix();
    normalised += normalised_square(error, covariance);
  }

  int runs = 0;
  VectorXd errors, squares, variances;
  Eigen::VectorXi covered;
  double normalised = 0.0;
};

bool diverged(const VectorXd& error, const MatrixXd& covariance, const VectorXd& largest) {
  if (!error.allFinite() || !covariance.allFinite()) return true;
  return largest.size() > 0 && (error.array().abs() > largest.array()).any();
}

void summarise(const Tally& tally, const VectorXd& bound, MonteCarloResult& result) {
  const auto runs = static_cast<double>(tally.runs), k = static_cast<double>(tally.errors.size());
  result.bias = tally.errors / runs;
  const VectorXd spread = (tally.squares / runs - result.bias.cwiseAbs2()).cwiseMax(0.0);
  result.bias_deviation = (spread / runs).cwiseSqrt();
  result.rms = (tally.squares / runs).cwiseSqrt();
  result.relative_rms_deviation = 1.0 / std::sqrt(2.0 * runs);
  result.rms_over_deviation = (tally.squares.array() / tally.variances.array()).sqrt();
  if (bound.size() > 0) result.rms_over_bound = result.rms.cwiseQuotient(bound);
  for (const int covered : tally.covered) result.coverage.push_back(proportion(covered, tally.runs));
  const double freedoms = runs * k;
  const boost::math::chi_squared distribution(freedoms);
  result.nees = tally.normalised / freedoms;
  result.nees_lower_999 = quantile(distribution, 0.0005) / freedoms;
  result.nees_upper_999 = quantile(complement(distribution, 0.0005)) / freedoms;
}

}  // namespace

Proportion proportion(int count, int runs) {
  if (runs < 1 || count < 0 || count > runs)
    throw std::invalid_argument("found " + std::to_string(count) + " of " + std::to_string(runs) +
                                "; expected 0 to as many as there are, and at least one");
  const double n = runs, p = count / n, z2 = two_sided_95 * two_sided_95;
  const double centre = (p + 0.5 * z2 / n) / (1.0 + z2 / n);
  const double half = two_sided_95 * std::sqrt(p * (1.0 - p) / n + 0.25 * z2 / (n * n)) / (1.0 + z2 / n);
  return {count, runs, std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

Estimator last_estimate_of(std::function<std::unique_ptr<Filter>()> make_filter, std::vector<Index> entries) {
  return [make = std::move(make_filter),
          places = std::move(entries)](const Trial& trial) -> std::optional<Gaussian> {
    const std::unique_ptr<Filter> filter = make();
    if (run(*filter, trial.initial, trial.record).failure) return std::nullopt;
    return filter->marginal(places);
  };
}

MonteCarloResult monte_carlo(const TrialGenerator& generate, const Estimator& estimate,
                             const MonteCarloSettings& settings) {
  if (settings.runs < 1)
    throw std::invalid_argument("runs: " + std::to_string(settings.runs) + "; expected at least 1");
  MonteCarloResult result;
  result.runs = settings.runs;
  std::optional<Tally> tally;
  for (int i = 0; i < settings.runs; ++i) {
    const std::uint64_t seed = settings.first_seed + static_cast<std::uint64_t>(i);
    const Trial trial = generate(seed);
    const Index k = trial.truth.size();
    if (!tally) tally.emplace(k);
    require_size(trial.truth, tally->errors.size(), "the truth");
    if (settings.bound.size() > 0) require_size(settings.bound, k, "the bound");
    if (settings.largest_error.size() > 0) require_size(settings.largest_error, k, "the largest error");
    const std::optional<Gaussian> found = estimate(trial);
    if (found) require_size(found->mean, k, "the estimate");
    if (found) {
      const VectorXd error = found->mean - trial.truth;
      const MatrixXd covariance = with_covariance(*found).covariance;
      if (!diverged(error, covariance, settings.largest_error)) {
        tally->add(error, covariance);
        continue;
      }
    }
    result.diverged_seeds.push_back(seed);
  }
  result.diverged = proportion(static_cast<int>(result.diverged_seeds.size()), settings.runs);
  if (tally->runs > 0) summarise(*tally, settings.bound, result);
  return result;
}

}  // namespace beamid::filters
