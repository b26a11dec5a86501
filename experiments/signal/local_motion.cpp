#include "experiments/signal/local_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

LocalMotion local_motion(const VectorXd& signal, double interval, double frequency_hz) {
  constexpr double fewest = 4, periods = 2;
  const double samples = 1 / (frequency_hz * interval);  // per period
  const auto length = static_cast<Index>(std::lround(periods * samples)),
             hop = std::max<Index>(1, std::lround(samples / LocalMotion::windows_per_period));
  if (!(samples >= fewest) || signal.size() < length) return {};
  MatrixXd basis(length, 5);
  for (Index k = 0; k < length; ++k) {
    const double from_middle = static_cast<double>(k) - 0.5 * static_cast<double>(length - 1),
                 s = from_middle / static_cast<double>(length),
                 angle = 2 * std::numbers::pi * from_middle / samples;
    basis.row(k) << 1, s, s * s, std::cos(angle), std::sin(angle);
  }
  const MatrixXd inverse = basis.colPivHouseholderQr().solve(MatrixXd::Identity(length, length));
  const Index count = (signal.size() - length) / hop + 1;
  LocalMotion motion{VectorXd(count), VectorXd(count), VectorXd(count)};
  for (Index i = 0; i < count; ++i) {
    const VectorXd found = inverse * signal.segment(i * hop, length);
    motion.time[i] = interval * (static_cast<double>(i * hop) + 0.5 * static_cast<double>(length - 1));
    motion.amplitude[i] = std::hypot(found[3], found[4]);
    motion.offset[i] = found[0];
  }
  return motion;
}

}  // namespace beamid::experiments
