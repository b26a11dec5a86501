#include "experiments/modal/response_peaks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/signal/least_squares.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::VectorXcd, Eigen::VectorXd;

/// What a peak reaches to one side: down to half its power, or to the valley before a larger value.
struct Side {
  Index end;            ///< the last line still above half power
  double valley;        ///< smallest power before a larger one
  bool larger = false;  ///< whether a larger one comes
};

Side side_of(const VectorXd& power, Index peak, Index direction) {
  Side side{peak, power[peak]};
  bool above = true;
  for (Index k = peak + direction; k >= 0 && k < power.size(); k += direction) {
    if (power[k] > power[peak]) {
      side.larger = true;
      break;
    }
    above = above && power[k] >= 0.5 * power[peak] && power[k] <= power[k - direction];
    if (above) side.end = k;
    side.valley = std::min(side.valley, power[k]);
  }
  return side;
}

struct LocalFit {
  Complex rate;
  double misfit;  ///< what is left of the lines, over the mode's own part of them
};

/// Of the lines [first, first + count).
LocalFit local_fit(const VectorXcd& s, const MatrixXcd& receptance, Index first, Index count) {
  const Index outputs = receptance.rows();
  MatrixXcd matrix = MatrixXcd::Zero(outputs * count, 1 + 2 * outputs);
  VectorXcd right(outputs * count);
  const Complex centre = s[first + count / 2];  // the same equation in s - centre, whose numbers are small
  for (Index o = 0; o < outputs; ++o) {
    const double scale = 1 / std::max(receptance.row(o).segment(first, count).norm(), 1e-300);
    for (Index k = 0; k < count; ++k) {
      const Complex h = scale * receptance(o, first + k), from = s[first + k] - centre;
      matrix(o * count + k, 0) = h;
      matrix(o * count + k, 1 + 2 * o) = from;
      matrix(o * count + k, 2 + 2 * o) = 1;
      right[o * count + k] = from * h;
    }
  }
  const VectorXcd parts = complex_least_squares(matrix, right);
  const VectorXcd left = matrix * parts - right;
  double squares = 0, own = 0;
  for (Index o = 0; o < outputs; ++o)
    for (Index k = 0; k < count; ++k) {
      const Complex from = s[first + k] - centre - parts[0];
      squares += std::norm(left[o * count + k] / from);
      own += std::norm((parts[2 + 2 * o] + parts[1 + 2 * o] * parts[0]) / from);
    }
  return {centre + parts[0], std::sqrt(squares / std::max(own, 1e-300))};
}

}  // namespace

std::vector<Pole> poles_at_peaks(const VectorXd& frequency_hz, const MatrixXcd& responses, double shift,
                                 int power, double smallest) {
  constexpr double above_valley = 1.2, largest_misfit = 0.1;
  const Index lines = frequency_hz.size();
  VectorXcd s(lines);
  VectorXd mobility(lines);
  MatrixXcd receptance(responses.rows(), lines);
  for (Index k = 0; k < lines; ++k) {
    s[k] = Complex(shift, 2 * std::numbers::pi * frequency_hz[k]);
    receptance.col(k) = responses.col(k) / std::pow(s[k], power);
    mobility[k] = receptance.col(k).squaredNorm() * std::norm(s[k]);
  }
  const double least = smallest * smallest * mobility.maxCoeff();
  std::vector<Pole> poles;
  for (Index k = 1; k + 1 < lines; ++k) {
    if (mobility[k] < least || mobility[k] < mobility[k - 1] || mobility[k] <= mobility[k + 1]) continue;
    const Side left = side_of(mobility, k, -1), right = side_of(mobility, k, 1);
    const double valley = std::max(left.larger ? left.valley : 0, right.larger ? right.valley : 0);
    if (mobility[k] < above_valley * above_valley * valley) continue;
    const Index first = std::max<Index>(0, std::min(left.end, k - 2)),
                last = std::min(lines - 1, std::max(right.end, k + 2));
    const auto [rate, misfit] = local_fit(s, receptance, first, last - first + 1);
    const double turn = 2 * std::numbers::pi;
    if (!(misfit < largest_misfit && rate.real() < 0 &&
          rate.imag() > turn * frequency_hz[first] - std::abs(rate.real()) &&
          rate.imag() < turn * frequency_hz[last] + std::abs(rate.real())))
      continue;
    poles.push_back({rate, VectorXcd::Ones(responses.rows())});
  }
  return poles;
}

}  // namespace beamid::experiments
