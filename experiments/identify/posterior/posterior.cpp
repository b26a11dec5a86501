#include "experiments/identify/posterior/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <boost/math/special_functions/erf.hpp>

#include "experiments/identify/posterior/samplers.hpp"
#include "experiments/signal/in_double.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {

double below_normal(double u) {
  return 0.5 * std::erfc(-u / std::numbers::sqrt2);
}

double normal_quantile(double share) {
  if (!(share > 0.0)) return -std::numeric_limits<double>::infinity();
  if (!(share < 1.0)) return std::numeric_limits<double>::infinity();
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * share, InDouble{});
}

double normal_density(double u) {
  return std::exp(-0.5 * u * u) * 0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2;
}

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double wanted_acceptance = 0.9;
constexpr double shortest_share = 0.3;  // of the one found: tails may be narrower than where it was found

/// Dual averaging of ln(step) [hoffman2014, section 3.2].
struct StepSearch {
  double centre, mean = 0.0, log_step, averaged = 0.0;
  int count = 0;
  explicit StepSearch(double first) : centre(std::log(10.0 * first)), log_step(std::log(first)) {}
  void learn(double acceptance) {
    const double t = ++count, share = 1.0 / (t + 10.0), weight = std::pow(t, -0.75);
    mean = (1.0 - share) * mean + share * (wanted_acceptance - acceptance);
    log_step = centre - std::sqrt(t) / 0.05 * mean;
    averaged = weight * log_step + (1.0 - weight) * averaged;
  }
};

// Covariance within the humps, by their shares.
MatrixXd common_root(const HumpMixture& mixture) {
  const Index q = mixture.part(0).centre.size();
  MatrixXd covariance = MatrixXd::Zero(q, q);
  double sum = 0.0;
  for (std::size_t h = 0; h < mixture.size(); ++h) {
    covariance += mixture.part(h).share * mixture.part(h).root.reconstructedMatrix();
    sum += mixture.part(h).share;
  }
  return (covariance / sum).llt().matrixL();
}

PosteriorChain one_chain(const Likelihood& likelihood, const HumpMixture& mixture, const VectorXd& start,
                         const ChainSettings& settings, const MatrixXd& root, filters::RandomStream random) {
  const ChainDensity density = [&](const VectorXd& y) -> ChainPlace {
    const VectorXd u = root * y;
    const LikelihoodValue value = likelihood.at(u, true);
    if (!value.possible()) return {y, value.log, VectorXd::Zero(y.size())};
    return {y, posterior_log(value, u), root.transpose() * (value.gradient - u)};
  };
  PosteriorChain chain{MatrixXd(start.size(), static_cast<Index>(settings.draws)),
                       VectorXd(static_cast<Index>(settings.draws))};
  ChainPlace here = density(root.triangularView<Eigen::Lower>().solve(start));
  StepSearch search(0.5);
  double step = 0.5;
  for (std::size_t i = 0; i < settings.warm_up + settings.draws; ++i) {
    const bool warm = i >= settings.warm_up;
    const VectorXd u = root * here.y, other = mixture.draw(random);
    const double threshold = std::log(random.uniform());
    const double there = posterior_log(likelihood.at(other, false), other);
    if (threshold < there - here.log + mixture.log_density(u) - mixture.log_density(other)) {
      here = density(root.triangularView<Eigen::Lower>().solve(other));
      chain.jumps += warm ? 1 : 0;
    }
    const double taken = warm ? step * (shortest_share + (1.0 - shortest_share) * random.uniform()) : step;
    Trajectory path = no_u_turn(density, here, taken, random);
    here = std::move(path.end);
    chain.leaps += static_cast<std::size_t>(path.leaps);
    if (!warm) {
      search.learn(path.acceptance);
      step = std::clamp(std::exp(search.log_step), 1e-4, 2.0);
      if (i + 1 == settings.warm_up) step = std::clamp(std::exp(search.averaged), 1e-4, 2.0);
      continue;
    }
    chain.divergences += path.diverged ? 1 : 0;
    const auto k = static_cast<Index>(i - settings.warm_up);
    chain.draws.col(k) = root * here.y;
    chain.log_posterior[k] = here.log;
  }
  chain.step = step;
  return chain;
}

}  // namespace

std::vector<PosteriorChain> posterior_chains(const Likelihood& likelihood, const HumpMixture& mixture,
                                             const MatrixXd& starts, const ChainSettings& settings,
                                             std::uint64_t seed) {
  const MatrixXd root = common_root(mixture);
  std::vector<PosteriorChain> chains(settings.chains);
  tbb::parallel_for(
      std::size_t{0}, chains.size(),
      [&](std::size_t c) {
        const auto start = static_cast<Index>(c) % starts.cols();
        chains[c] = one_chain(likelihood, mixture, starts.col(start), settings, root,
                              filters::RandomStream(seed, (std::uint64_t{1} << 48) + c));
      },
      tbb::simple_partitioner());
  return chains;
}

namespace {

MatrixXd halves_of(const MatrixXd& draws) {
  const Index half = draws.rows() / 2;
  MatrixXd halves(half, 2 * draws.cols());
  halves << draws.topRows(half), draws.bottomRows(half);
  return halves;
}

// Normal quantiles of the ranks, ties at their mean rank.
MatrixXd ranked(const MatrixXd& draws) {
  std::vector<Index> order(static_cast<std::size_t>(draws.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return draws.data()[a] < draws.data()[b]; });
  MatrixXd scores(draws.rows(), draws.cols());
  const auto n = static_cast<double>(draws.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && draws.data()[order[end]] == draws.data()[order[i]]) ++end;
    const double rank = 0.5 * static_cast<double>(i + 1 + end);
    for (; i < end; ++i) scores.data()[order[i]] = normal_quantile((rank - 0.375) / (n + 0.25));
  }
  return scores;
}

// Within the chains, and of all of them.
struct ChainVariances {
  double within, whole;
  explicit ChainVariances(const MatrixXd& draws) {
    const auto n = static_cast<double>(draws.rows());
    const Eigen::RowVectorXd means = draws.colwise().mean();
    within = (draws.rowwise() - means).squaredNorm() / static_cast<double>(draws.cols()) / (n - 1.0);
    const double between =
        (means.array() - means.mean()).square().sum() / std::max(1.0, static_cast<double>(draws.cols() - 1));
    whole = (n - 1.0) / n * within + between;
  }
  double r_hat() const { return within > 0.0 ? std::sqrt(whole / within) : 1.0; }
};

// Geyer's initial monotone sequence of the autocorrelations.
double effective_draws(const MatrixXd& draws) {
  const ChainVariances variances(draws);
  const Index n = draws.rows();
  const auto total = static_cast<double>(draws.size());
  if (!(variances.whole > 0.0)) return total;
  const MatrixXd gap = draws.rowwise() - draws.colwise().mean();
  const auto correlation = [&](Index lag) {
    double covariance = 0.0;
    for (Index c = 0; c < gap.cols(); ++c)
      covariance += gap.col(c).head(n - lag).dot(gap.col(c).tail(n - lag)) / static_cast<double>(n);
    covariance /= static_cast<double>(gap.cols());
    return 1.0 - (variances.within - covariance) / variances.whole;
  };
  double sum = -1.0, last = 1e9;
  for (Index lag = 0; lag + 1 < n; lag += 2) {
    const double pair = std::min(last, correlation(lag) + correlation(lag + 1));
    if (pair <= 0.0) break;
    sum += 2.0 * pair;
    last = pair;
  }
  return std::min(total / std::max(sum, 1.0 / std::log10(total)), total * std::log10(total));
}

}  // namespace

ChainConvergence chain_convergence(const MatrixXd& draws) {
  const MatrixXd halves = halves_of(draws);
  const MatrixXd places = ranked(halves);
  std::vector<double> all(halves.data(), halves.data() + halves.size());
  const MatrixXd spreads = ranked((halves.array() - median(all)).abs());
  double effective = effective_draws(places);
  for (const double share : {0.05, 0.95}) {
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), all.begin() + place, all.end());
    const double quantile = all[static_cast<std::size_t>(place)];
    effective = std::min(effective, effective_draws((halves.array() <= quantile).cast<double>().matrix()));
  }
  return {std::max(ChainVariances(places).r_hat(), ChainVariances(spreads).r_hat()), effective};
}

namespace {

constexpr Index most_climbers = 200;
// [-], [nat]. A tempering's evidence has the true one as its mean, so that it is most_above larger with a
// probability of e^-most_above at most (Markov), however it is distributed. Too small it often is: of narrow
// posteriors by some nat, without anything amiss.
constexpr double notable_share = 0.01, most_apart = 4.0, most_above = 3.0;

MatrixXd climb_starts(const TemperedDraws& first, const TemperedDraws& second, const MatrixXd& known,
                      const PosteriorSettings& settings) {
  std::vector<VectorXd> starts;
  for (const TemperedDraws* const one : {&first, &second}) {
    const Index stride = std::max<Index>(1, 2 * one->draws.cols() / most_climbers);
    for (Index i = 0; i < one->draws.cols(); i += stride) starts.emplace_back(one->draws.col(i));
  }
  filters::RandomStream random(settings.seed + 4, 0);
  for (std::size_t i = 0; i < settings.prior_climbs; ++i)
    starts.emplace_back(random.normal(first.draws.rows(), 1));
  MatrixXd all(first.draws.rows(), static_cast<Index>(starts.size()) + known.cols());
  for (std::size_t i = 0; i < starts.size(); ++i) all.col(static_cast<Index>(i)) = starts[i];
  if (known.cols() > 0) all.rightCols(known.cols()) = known;
  return all;
}

// ln of the mean of two evidences.
double log_mean(double a, double b) {
  return std::max(a, b) + std::log(0.5 * (1.0 + std::exp(-std::abs(a - b))));
}

void judge_chains(const HumpMixture& mixture, Posterior& result) {
  const Index q = result.chains.front().draws.rows(), n = result.chains.front().draws.cols();
  const auto count = static_cast<Index>(result.chains.size());
  for (Index j = 0; j <= q; ++j) {
    MatrixXd values(n, count);
    for (Index c = 0; c < count; ++c) {
      const PosteriorChain& chain = result.chains[static_cast<std::size_t>(c)];
      values.col(c) = j < q ? VectorXd(chain.draws.row(j)) : chain.log_posterior;
    }
    result.convergence.push_back(chain_convergence(values));
  }
  result.chain_share.assign(mixture.size(), 0.0);
  for (const PosteriorChain& chain : result.chains) {
    std::vector<std::size_t>& humps = result.hump_of.emplace_back();
    for (Index k = 0; k < n; ++k) {
      humps.push_back(mixture.hump(chain.draws.col(k)));
      result.chain_share[humps.back()] += 1.0 / static_cast<double>(n * count);
    }
    result.evaluations += chain.leaps + 2 * static_cast<std::size_t>(n);
  }
}

}  // namespace

Posterior sample_posterior(const Likelihood& likelihood, const MatrixXd& known,
                           const PosteriorSettings& settings, const Progress& progress) {
  Posterior result;
  result.tempered = tempered_draws(likelihood, settings.particles, settings.seed, progress);
  constexpr std::uint64_t other_seed = 0x9e3779b9;
  TemperedDraws second = tempered_draws(likelihood, settings.particles, settings.seed + other_seed, progress);
  progress("maxima");
  result.humps = separate_humps(likelihood, climb_starts(result.tempered, second, known, settings));
  const double evidence = log_mean(result.tempered.log_evidence, second.log_evidence);
  const std::size_t evaluations = result.tempered.evaluations + second.evaluations;
  result.tempered_apart = std::abs(result.tempered.log_evidence - second.log_evidence);
  if (second.log_evidence > result.tempered.log_evidence) result.tempered = std::move(second);
  result.tempered.log_evidence = evidence;
  result.tempered.evaluations = evaluations;
  if (result.humps.empty()) throw std::invalid_argument("no maximum of the posterior was found");
  HumpMixture mixture(result.humps);
  progress("evidence");
  result.importance = importance_sample(likelihood, mixture, settings.importance_draws, settings.seed + 1);
  result.share = result.importance.share;
  progress("chains");
  const Index stride =
      std::max<Index>(1, result.tempered.draws.cols() / static_cast<Index>(settings.chains.chains));
  MatrixXd starts(likelihood.size(), static_cast<Index>(settings.chains.chains));
  for (Index c = 0; c < starts.cols(); ++c)
    starts.col(c) = result.tempered.draws.col((c * stride) % result.tempered.draws.cols());
  result.chains = posterior_chains(likelihood, mixture, starts, settings.chains, settings.seed + 2);
  result.evaluations = result.tempered.evaluations + result.importance.evaluations;
  judge_chains(mixture, result);
  if (result.importance.poor()) result.share = result.chain_share;
  return result;
}

std::size_t Posterior::notable_humps() const {
  return static_cast<std::size_t>(
      std::count_if(share.begin(), share.end(), [](double one) { return one >= notable_share; }));
}

double Posterior::worst_r_hat() const {
  double worst = 1.0;
  for (const ChainConvergence& one : convergence) worst = std::max(worst, one.r_hat);
  return worst;
}

double Posterior::fewest_effective() const {
  double fewest = convergence.front().effective_draws;
  for (const ChainConvergence& one : convergence) fewest = std::min(fewest, one.effective_draws);
  return fewest;
}

std::size_t Posterior::divergences() const {
  std::size_t sum = 0;
  for (const PosteriorChain& chain : chains) sum += chain.divergences;
  return sum;
}

std::size_t Posterior::draws() const {
  return chains.size() * static_cast<std::size_t>(chains.front().draws.cols());
}

VectorXd Posterior::best_draw() const {
  VectorXd best = humps.front().top;
  double highest = humps.front().log_density;
  for (const Hump& one : humps)
    if (one.log_density > highest) highest = one.log_density, best = one.top;
  for (const PosteriorChain& chain : chains) {
    Index at = 0;
    const double here = chain.log_posterior.maxCoeff(&at);
    if (here > highest) highest = here, best = chain.draws.col(at);
  }
  return best;
}

bool Posterior::humps_are_uncertain() const {
  return importance.poor() ? tempered_apart > most_apart
                           : tempered.log_evidence - importance.log_evidence > most_above;
}

std::vector<std::string> Posterior::complaints() const {
  std::vector<std::string> list;
  if (!(worst_r_hat() < largest_r_hat))
    list.push_back(
        fmt::format("chains differ: R-hat {:.3f}, expected below {}", worst_r_hat(), largest_r_hat));
  if (fewest_effective() < fewest_effective_draws)
    list.push_back(fmt::format("the draws are worth {:.0f} independent ones, expected {:.0f}",
                               fewest_effective(), fewest_effective_draws));
  if (divergences() * 200 > draws())
    list.push_back(fmt::format("{} of {} trajectories diverged", divergences(), draws()));
  if (importance.poor())
    list.emplace_back(
        "the humps are no humps a mixture would resemble: evidence and weights are those of the samplers");
  else if (humps_are_uncertain())
    list.push_back(
        fmt::format("tempering finds {:.1f} nat more evidence than the humps hold, expected at most {}",
                    tempered.log_evidence - importance.log_evidence, most_above));
  if (importance.poor() && tempered_apart > most_apart)
    list.push_back(fmt::format(
        "two independent temperings differ by {:.1f} nat, expected at most {}: request more particles",
        tempered_apart, most_apart));
  for (std::size_t h = 0; h < share.size(); ++h)
    if (const double spread = std::sqrt(std::max(share[h] * (1.0 - share[h]), 1e-6) / fewest_effective());
        std::abs(share[h] - chain_share[h]) > 5.0 * spread + 0.01) {
      list.emplace_back("the chains' shares of the humps differ from their weights");
      break;
    }
  return list;
}

}  // namespace beamid::experiments
