#include "experiments/modal/third_overtone.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "experiments/modal/eigensystem_realisation.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Samples that were measured, at their instants [s].
struct Measured {
  VectorXd samples, time;
};

Measured measured_of(const VectorXd& signal, double interval) {
  std::vector<Index> at;
  for (Index k = 0; k < signal.size(); ++k)
    if (std::isfinite(signal[k])) at.push_back(k);
  Measured result{signal(at), VectorXd(static_cast<Index>(at.size()))};
  for (std::size_t i = 0; i < at.size(); ++i)
    result.time[static_cast<Index>(i)] = interval * static_cast<double>(at[i]);
  return result;
}

}  // namespace

std::string ThirdOvertone::words() const {
  return fmt::format(
      "An overtone at three times the frequency, {} it, has {:.2g} % of the amplitude at first. A sensor "
      "near the end of its range {} its largest readings by {:.2g} %, or the stiffness is not linear.",
      compression > 0 ? "against" : "in phase with", 100 * share, compression > 0 ? "lowers" : "raises",
      100 * std::abs(compression));
}

std::optional<ThirdOvertone> third_overtone(const VectorXd& signal, double interval,
                                            const ModalEstimate& mode) {
  constexpr double fewest = 7, clearly = 8, least_share = 0.005, in_phase = 0.44;  // [rad]
  constexpr int beside = 6;
  if (!(mode.frequency_hz * interval * fewest < 1)) return {};
  const Measured measured = measured_of(signal, interval);
  const Complex rate = mode.rate();
  const double d = -rate.real(), w = rate.imag(), length = measured.time.tail(1)[0];
  std::vector<Complex> known{rate};
  for (const CompanionMode& other : mode.companions) known.push_back(other.rate());
  std::vector<bool> oscillating(known.size(), true);
  known.emplace_back(0);
  oscillating.push_back(false);
  const ShapeFit motion = fit_shapes_at(measured.samples.transpose(), measured.time, known, oscillating);
  const MatrixXd left = measured.samples.transpose() - motion.reconstruction;
  const auto at = [&](double frequency) {
    return fit_shapes_at(left, measured.time, {{-d, frequency}, {-3 * d, frequency}}, {true, true});
  };
  const ShapeFit overtone = at(3 * w);
  const Complex amplitude = motion.shapes(0, 0), third = overtone.shapes.sum();
  const double share = std::abs(third) / std::abs(amplitude),
               phase = std::remainder(std::arg(third) - 3 * std::arg(amplitude), 2 * std::numbers::pi);
  const bool against = std::abs(phase) > std::numbers::pi / 2;
  const double off = against ? std::numbers::pi - std::abs(phase) : std::abs(phase);
  if (!(share > least_share) || off > in_phase) return {};
  // Lines of the two shapes are some d / pi wide, of a short signal 1 / length; even overtones are w away.
  const double line = std::max(4 * std::numbers::pi / length, 4 * std::abs(d)),
               nearest = std::min(2 * line, 0.3 * w), farthest = std::clamp(7 * line, nearest, 0.45 * w);
  std::vector<double> around;
  for (const double away : VectorXd::LinSpaced(beside, nearest, farthest))
    for (const int side : {-1, 1}) around.push_back(at(3 * w + side * away).reconstruction.squaredNorm());
  if (!(overtone.reconstruction.squaredNorm() > clearly * median(std::move(around)))) return {};
  return ThirdOvertone{share, against ? 3 * share : -3 * share};
}

}  // namespace beamid::experiments
