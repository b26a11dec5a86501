#include "experiments/identify/posterior/hump_mixture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

}  // namespace beamid::experiments
