#include "experiments/identify/posterior/chain_convergence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "experiments/identify/posterior/normal_law.hpp"
#include "experiments/signal/median.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

}  // namespace beamid::experiments
