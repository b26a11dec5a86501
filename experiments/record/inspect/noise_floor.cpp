#include "experiments/record/inspect/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/FFT>
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

/// Variance of white noise with the periodogram that a window of the signal has.
double white_variance(const VectorXd& window, Eigen::FFT<double>& transform) {
  const Index size = window.size();
  const VectorXd place = VectorXd::LinSpaced(size, -1, 1);
  const double slope = place.dot(window) / place.squaredNorm();
  const double turn = 2 * std::numbers::pi / static_cast<double>(size);
  std::vector<double> tapered(static_cast<std::size_t>(size));
  double taper_squares = 0.0;
  for (Index k = 0; k < size; ++k) {
    const double taper = 1 - std::cos(turn * (static_cast<double>(k) + 0.5));
    tapered[static_cast<std::size_t>(k)] = taper * (window[k] - window.mean() - slope * place[k]);
    taper_squares += taper * taper;
  }
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, tapered);
  std::vector<double> powers;
  for (Index k = size / 8; k < 3 * size / 8; ++k)
    powers.push_back(std::norm(spectrum[static_cast<std::size_t>(k)]));
  return quantile(powers, 0.5) / std::numbers::ln2 / taper_squares;
}

}  // namespace

double noise_floor(const VectorXd& signal) {
  constexpr Index longest = 512, fewest = 64;
  if (signal.size() < fewest)
    throw std::invalid_argument("signal of " + std::to_string(signal.size()) +
                                " samples; expected at least 64 to find its noise");
  Index size = longest;
  while (size > signal.size()) size /= 2;
  Eigen::FFT<double> transform;
  std::vector<double> variances;
  for (Index begin = 0; begin + size <= signal.size(); begin += size)
    variances.push_back(white_variance(signal.segment(begin, size), transform));
  return std::sqrt(quantile(variances, 0.25));
}

}  // namespace beamid::experiments
