#include "experiments/modal/force_error.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace beamid::experiments {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::VectorXcd, Eigen::VectorXd;

ForceErrors force_errors(const HammerResponses& responses, Index first, Index lines) {
  constexpr double groups_per_cycle = 8;
  const double interval = responses.interval, hits = responses.averages;
  const VectorXd f = responses.frequency_hz.segment(first, lines),
                 force = responses.force_spectrum.segment(first, lines) / interval;
  const VectorXcd mean = responses.force_mean.segment(first, lines);
  const auto together =
      std::max<Index>(1, static_cast<Index>(1 / (groups_per_cycle * f[lines - 1] * interval)));
  const Index groups = (responses.force_noise.size() + together - 1) / together;
  ForceErrors found{MatrixXcd(lines, groups), MatrixXcd(lines, 2)};
  for (Index g = 0; g < groups; ++g) {
    const Index begin = g * together, size = std::min(together, responses.force_noise.size() - begin);
    const double noise = responses.force_noise.segment(begin, size).norm() / std::sqrt(hits);
    const double time = interval * (static_cast<double>(begin) + 0.5 * static_cast<double>(size - 1));
    for (Index k = 0; k < lines; ++k)
      found.noise(k, g) =
          noise / force[k] * std::polar(1.0, -2 * std::numbers::pi * f[k] * time - std::arg(mean[k]));
  }
  for (Index k = 0; k < lines; ++k) {
    const double size = responses.unresolved * responses.force_spectrum[0] / interval / force[k];
    found.aliases(k, 0) = size;
    found.aliases(k, 1) = Complex(0, size * std::min(1.0, std::numbers::pi * f[k] * responses.pulse_s));
  }
  return found;
}

}  // namespace beamid::experiments
