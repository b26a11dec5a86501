#include "experiments/identify/posterior/chains.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/posterior/no_u_turn.hpp"

namespace beamid::experiments {
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

}  // namespace beamid::experiments
