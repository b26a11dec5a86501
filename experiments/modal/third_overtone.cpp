#include "experiments/modal/third_overtone.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "experiments/signal/median.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Complex imaginary{0, 1};

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

/// Re and -Im of e^(rate t), a pair of columns for each rate.
MatrixXd columns_of(const std::vector<Complex>& rates, const VectorXd& time) {
  MatrixXd columns(time.size(), 2 * static_cast<Index>(rates.size()));
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Eigen::ArrayXcd wave = (rates[i] * time.cast<Complex>()).array().exp();
    columns.col(2 * static_cast<Index>(i)) = wave.real();
    columns.col(2 * static_cast<Index>(i) + 1) = -wave.imag();
  }
  return columns;
}

/// Energy that the columns take of a signal, and their coefficients.
struct Taken {
  double energy = 0;
  VectorXd coefficients;
};

Taken taken_by(const MatrixXd& columns, const VectorXd& signal) {
  VectorXd x = columns.householderQr().solve(signal);
  const double energy = (columns * x).squaredNorm();
  return {energy, std::move(x)};
}

}  // namespace

std::string ThirdOvertone::words() const {
  return fmt::format(
      "An overtone at three times the frequency, {} it, has {:.2g} % of the amplitude at first: a sensor "
      "near "
      "the end of its range {} its largest readings by {:.2g} %, or the stiffness is not linear.",
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
  MatrixXd explained(measured.time.size(), 2 * static_cast<Index>(known.size()) + 1);
  explained << columns_of(known, measured.time), VectorXd::Ones(measured.time.size());
  const VectorXd of_known = explained.householderQr().solve(measured.samples),
                 left = measured.samples - explained * of_known;
  // Lines of the two shapes are some d / pi wide, of a short signal 1 / length; even overtones are w away.
  const double line = std::max(4 * std::numbers::pi / length, 4 * std::abs(d)),
               nearest = std::min(2 * line, 0.3 * w), farthest = std::clamp(7 * line, nearest, 0.45 * w);
  const auto at = [&](double frequency) {
    return taken_by(columns_of({-d + imaginary * frequency, -3 * d + imaginary * frequency}, measured.time),
                    left);
  };
  const Taken overtone = at(3 * w);
  std::vector<double> around;
  for (const double away : VectorXd::LinSpaced(beside, nearest, farthest))
    for (const int side : {-1, 1}) around.push_back(at(3 * w + side * away).energy);
  if (!(overtone.energy > clearly * median(std::move(around)))) return {};
  const Complex amplitude(of_known[0], of_known[1]),
      third(overtone.coefficients[0] + overtone.coefficients[2],
            overtone.coefficients[1] + overtone.coefficients[3]);
  const double share = std::abs(third) / std::abs(amplitude),
               phase = std::remainder(std::arg(third) - 3 * std::arg(amplitude), 2 * std::numbers::pi);
  const bool against = std::abs(phase) > std::numbers::pi / 2;
  const double off = against ? std::numbers::pi - std::abs(phase) : std::abs(phase);
  if (!(share > least_share) || off > in_phase) return {};
  return ThirdOvertone{share, against ? 3 * share : -3 * share};
}

}  // namespace beamid::experiments
