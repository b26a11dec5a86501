#include "experiments/identify/posterior/posterior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
    list.push_back(
        fmt::format("two independent temperings differ by {:.1f} nat, expected at most {}: ask for "
                    "more particles",
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
