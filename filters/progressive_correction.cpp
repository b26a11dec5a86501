#include "filters/progressive_correction.hpp"

#include <cmath>

namespace beamid::filters {

using Eigen::VectorXd;

Reweighted reweighted(const VectorXd& weights, const VectorXd& squares, double share) {
  const double least = squares.minCoeff();
  Reweighted result{weights.array() * (-0.5 * share * (squares.array() - least)).exp(), 0.0};
  const double sum = result.weights.sum();
  result.weights /= sum;
  result.log_sum = std::log(sum) - 0.5 * share * least;
  return result;
}

double affordable_share(const VectorXd& weights, const VectorXd& squares, double left, double enough) {
  const auto size = [&](double share) {
    return 1.0 / reweighted(weights, squares, share).weights.squaredNorm();
  };
  if (size(left) >= enough) return left;
  double low = 0.0, high = left;
  for (int i = 0; i < 60 && high - low > 1e-2 * high; ++i) {
    const double middle = low > 0.0 ? std::sqrt(low * high) : 1e-2 * high;
    if (size(middle) >= enough)
      low = middle;
    else
      high = middle;
  }
  return low > 0.0 ? low : high;
}

}  // namespace beamid::filters
