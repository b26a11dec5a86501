#include "experiments/identify/posterior/importance.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
