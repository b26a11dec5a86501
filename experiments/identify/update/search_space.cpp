#include "experiments/identify/update/search_space.hpp"

#include <algorithm>
#include <cmath>

#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double farthest_factor = 1e4, start_factor = 5.0;
constexpr std::uint64_t start_seed = 1;

}  // namespace

SearchSpace::SearchSpace(const AskedParameters& asked) {
  const auto q = static_cast<Index>(asked.unknowns.size());
  guess_.resize(q);
  scale_.resize(q);
  lower_.resize(q);
  upper_.resize(q);
  from_.resize(q);
  to_.resize(q);
  longest_step_.setOnes(q);
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = asked.unknowns[static_cast<std::size_t>(j)];
    const bool signed_quantity = unknown.quantity == "axial_load";
    logarithmic_.push_back(unknown.guess > 0.0 && !signed_quantity &&
                           !(unknown.form == Form::bounded && unknown.lower <= 0.0));
    stated_.push_back(unknown.form == Form::bounded);
    guess_[j] = unknown.guess;
    scale_[j] = std::max(std::abs(unknown.guess), unknown.deviation);
    const auto x = [&](double p) {
      return logarithmic_.back() ? std::log(p / guess_[j]) : (p - guess_[j]) / scale_[j];
    };
    if (stated_.back()) {
      lower_[j] = from_[j] = x(unknown.lower);
      upper_[j] = to_[j] = x(unknown.upper);
    } else if (logarithmic_.back()) {
      upper_[j] = std::log(farthest_factor);
      to_[j] = std::log(start_factor);
      lower_[j] = -upper_[j];
      from_[j] = -to_[j];
    } else {
      upper_[j] = farthest_factor;
      lower_[j] = signed_quantity ? -farthest_factor : x(0.0);
      from_[j] = std::max(-3.0 * unknown.deviation / scale_[j], lower_[j]);
      to_[j] = 3.0 * unknown.deviation / scale_[j];
    }
  }
}

SearchSpace::SearchSpace(const AskedParameters& asked, const std::vector<std::pair<double, double>>& likely)
    : SearchSpace(asked) {
  VectorXd from(size()), to(size());
  for (Index j = 0; j < size(); ++j) {
    from[j] = likely[static_cast<std::size_t>(j)].first;
    to[j] = likely[static_cast<std::size_t>(j)].second;
  }
  from_ = place(from);
  to_ = place(to);
  longest_step_ = longest_step_.cwiseMax(0.2 * (upper_ - lower_));
}

VectorXd SearchSpace::physical(const VectorXd& x) const {
  VectorXd values(size());
  for (Index j = 0; j < size(); ++j)
    values[j] = logarithmic(j) ? guess_[j] * std::exp(x[j]) : guess_[j] + scale_[j] * x[j];
  return values;
}

VectorXd SearchSpace::slope(const VectorXd& x) const {
  VectorXd slopes(size());
  for (Index j = 0; j < size(); ++j) slopes[j] = logarithmic(j) ? guess_[j] * std::exp(x[j]) : scale_[j];
  return slopes;
}

VectorXd SearchSpace::place(const VectorXd& values) const {
  VectorXd x(size());
  for (Index j = 0; j < size(); ++j)
    x[j] = logarithmic(j) ? std::log(values[j] / guess_[j]) : (values[j] - guess_[j]) / scale_[j];
  return x.cwiseMax(lower_).cwiseMin(upper_);
}

VectorXd SearchSpace::start(std::size_t number) const {
  VectorXd x = VectorXd::Zero(size());
  if (number == 0) return x;
  filters::RandomStream random(start_seed, number);
  for (Index j = 0; j < size(); ++j) x[j] = from_[j] + (to_[j] - from_[j]) * random.uniform();
  return x;
}

}  // namespace beamid::experiments
