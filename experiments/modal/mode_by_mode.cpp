#include "experiments/modal/mode_by_mode.hpp"

#include <fmt/format.h>

#include <numbers>
#include <optional>
#include <stdexcept>

#include "experiments/modal/spectral_peaks.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd;

/// In the channel where it is largest.
IsolatedMode isolated(const MatrixXd& outputs, double interval, double frequency_hz,
                      const std::vector<Complex>& all) {
  std::optional<IsolatedMode> best;
  for (Index i = 0; i < outputs.rows(); ++i) {
    IsolatedMode mode = isolate(outputs.row(i).transpose(), interval, frequency_hz, all);
    if (!best || std::abs(mode.values[0]) > std::abs(best->values[0])) best = std::move(mode);
  }
  return *best;
}

Pole pole_of(const ModeAnswer& answer, Index outputs) {
  Pole pole{answer.rate, Eigen::VectorXcd::Ones(outputs)};
  const double df = answer.frequency_deviation, dd = answer.damping_rate_deviation;
  pole.take_deviations(Eigen::Vector2d(df * df, dd * dd).asDiagonal());
  return pole;
}

std::string mode_by_mode_objection_to(const Pole& pole) {
  const double ratio = pole.damping_ratio(), deviation = pole.damping_ratio_deviation;
  const double room = deviation > 0 ? 2 * deviation : 0;
  if (!(ratio + room > 0)) return fmt::format("does not decay, damping ratio {:.3g} %", 100 * ratio);
  if (!(ratio > 0) || deviation > ratio)
    return fmt::format("too uncertain, damping ratio {:.2g} % with standard deviation {:.2g} %", 100 * ratio,
                       100 * deviation);
  return "";
}

}  // namespace

PoleSearch ModeByModeMethod::search(const MatrixXd& outputs, double interval, int) const {
  PoleSearch found;
  found.decays = outputs;
  found.orders.push_back({0, {}});
  std::vector<Complex> all;
  for (const double f : spectral_peaks(outputs, interval)) all.emplace_back(0, 2 * std::numbers::pi * f);
  for (const Complex& peak : all) {
    Pole pole{Complex(0, peak.imag()), Eigen::VectorXcd::Ones(outputs.rows())};
    std::string objection, remark;
    try {
      const ModeAnswer answer =
          estimate(isolated(outputs, interval, peak.imag() / (2 * std::numbers::pi), all));
      pole = pole_of(answer, outputs.rows());
      objection = mode_by_mode_objection_to(pole);
      remark = answer.remark;
    } catch (const std::invalid_argument& error) {
      objection = error.what();
    }
    if (!objection.empty()) {
      found.refused.push_back({pole, objection});
      continue;
    }
    found.orders.back().poles.push_back(pole);
    if (!remark.empty()) found.remarks.push_back(remark);
  }
  return found;
}

}  // namespace beamid::experiments
