#include "experiments/record/inspect/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/FFT>
#include <utility>
#include <vector>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Variances of white noise with the periodograms that windows of the signal have.
class WhiteVariance {
 public:
  explicit WhiteVariance(Index size) : place_(VectorXd::LinSpaced(size, -1, 1)), taper_(size) {
    const double turn = 2 * std::numbers::pi / static_cast<double>(size);
    for (Index k = 0; k < size; ++k) {
      taper_[k] = 1 - std::cos(turn * (static_cast<double>(k) + 0.5));
      taper_squares_ += taper_[k] * taper_[k];
    }
    tapered_.resize(static_cast<std::size_t>(size));
  }

  double of(const VectorXd& window) {
    const double slope = place_.dot(window) / place_.squaredNorm(), mean = window.mean();
    for (Index k = 0; k < window.size(); ++k)
      tapered_[static_cast<std::size_t>(k)] = taper_[k] * (window[k] - mean - slope * place_[k]);
    transform_.fwd(spectrum_, tapered_);
    std::vector<double> powers;
    for (Index k = window.size() / 8; k < 3 * window.size() / 8; ++k)
      powers.push_back(std::norm(spectrum_[static_cast<std::size_t>(k)]));
    return quantile(std::move(powers), 0.5) / std::numbers::ln2 / taper_squares_;
  }

 private:
  VectorXd place_, taper_;
  double taper_squares_ = 0.0;
  std::vector<double> tapered_;
  std::vector<std::complex<double>> spectrum_;
  Eigen::FFT<double> transform_;
};

}  // namespace

double noise_floor(const VectorXd& signal) {
  constexpr Index longest = 512, fewest = 64;
  if (signal.size() < fewest)
    throw std::invalid_argument("signal of " + std::to_string(signal.size()) +
                                " samples; expected at least 64 to find its noise");
  Index size = longest;
  while (size > signal.size()) size /= 2;
  WhiteVariance white(size);
  std::vector<double> variances;
  for (Index begin = 0; begin + size <= signal.size(); begin += size)
    variances.push_back(white.of(signal.segment(begin, size)));
  return std::sqrt(quantile(variances, 0.25));
}

}  // namespace beamid::experiments
