#include "experiments/modal/study/hammer_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/modal/study/hammer_modes.hpp"
#include "experiments/modal/study/signal_band.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::VectorXd;

/// How far the hammer and the response reach [Hz].
std::pair<double, double> reach(const HammerResponses& responses, const Record& record) {
  const VectorXd& f = responses.frequency_hz;
  constexpr double least = 0.1;
  const double peak = responses.force_spectrum.maxCoeff();
  Index top = 0;
  while (top + 1 < f.size() && responses.force_spectrum[top] > least * peak) ++top;
  const double signal = signal_band(record.samples, record.interval()).second;
  return {2 / responses.duration, std::min(f[top], signal)};
}

int power_of(const std::vector<Channel>& channels) {
  const Quantity quantity = channels.front().quantity;
  for (const Channel& channel : channels)
    if (channel.quantity != quantity || quantity == Quantity::strain)
      throw std::invalid_argument(
          "frequency responses are fitted in one quantity: displacement, velocity or acceleration");
  return times_differentiated(quantity);
}

void add_modes(HammerStudy& study) {
  const auto count = static_cast<Index>(study.fit.rates.size());
  const Index outputs = study.fit.residues.rows();
  const bool known = study.fit.covariance.size() > 0;
  for (Index m = 0; m < count; ++m) {
    HammerMode& mode = study.modes[m];
    mode.pole.rate = study.fit.rates[m];
    mode.pole.shape = study.fit.residues.col(m) / study.fit.residues.col(m).cwiseAbs().maxCoeff();
    if (known) mode.pole.take_deviations(study.fit.covariance.block<2, 2>(2 * m, 2 * m));
    const double turn = mode.pole.rate.imag();
    for (Index o = 0; o < outputs; ++o) {
      const std::complex<double> residue = study.fit.residues(o, m);
      const double size = std::abs(residue),
                   mass = study.responses.masses_lost ? Pole::unknown : 1 / (2 * turn * size);
      mode.mass.push_back(mass);
      mode.phase.push_back(std::arg(std::complex<double>(0, 2 * turn) * residue));
      const Index at = 2 * count + o * (2 * count + 2) + 2 * m;
      const Eigen::Vector2d slope(residue.real() / size, residue.imag() / size);
      mode.deviation.push_back(
          known ? mass / size * std::sqrt(slope.dot(study.fit.covariance.block<2, 2>(at, at) * slope))
                : Pole::unknown);
    }
  }
}

/// A real mode's residue is in phase with the force or opposed to it.
void judge_phases(HammerStudy& study) {
  constexpr double most = std::numbers::pi / 6;
  for (std::size_t m = 0; m < study.modes.size(); ++m) {
    HammerMode& mode = study.modes[m];
    for (std::size_t o = 0; o < mode.phase.size(); ++o) {
      const double size = std::abs(mode.phase[o]), off = std::min(size, std::numbers::pi - size);
      if (off <= most) continue;
      mode.complex = true;
      const std::string mass =
          std::isfinite(mode.mass[o]) ? fmt::format(" of {:.3g} kg", mode.mass[o]) : std::string();
      study.warnings.push_back(fmt::format(
          "The residue of mode {} at {:.4g} Hz{} has a phase of {:.0f} degrees, where a real mode has 0 or "
          "180: its modal mass{} is not to be trusted. A near mode that was missed, a rebound or a frequency "
          "that follows the amplitude does that.",
          m + 1, mode.pole.frequency_hz(),
          study.channels.size() > 1 ? " in " + study.channels[o].name : std::string(),
          mode.phase[o] * 180 / std::numbers::pi, mass));
    }
  }
}

}  // namespace

HammerStudy study_hits(const std::vector<std::string>& names, const std::vector<Record>& records,
                       const ModalStudySettings& settings) {
  const auto& registry = modal_method_registry();
  const auto options = registry.completed(settings.method.name, settings.method.options);
  const auto method = registry.make(settings.method.name, settings.method.options);
  HammerStudy study;
  study.names = names;
  study.remarks = records.front().remarks;
  for (std::size_t r = 0; r < records.size(); ++r)
    for (const std::string& warning : records[r].warnings)
      study.record_warnings.push_back(names[r] + ": " + warning);
  study.estimator = options.text("estimator");
  study.responses = hammer_responses(records, options.number("window_end"));
  Record motion = records.front();
  motion.samples.resize(records.front().samples.rows() - 1, Eigen::NoChange);
  for (Index i = 0, row = 0; i < records.front().samples.rows(); ++i)
    if (records.front().channels[i].quantity != Quantity::force) {
      motion.samples.row(row++) = records.front().samples.row(i);
      study.channels.push_back(records.front().channels[i]);
    }
  study.power = power_of(study.channels);
  study.band_hz = settings.band_hz ? *settings.band_hz : reach(study.responses, motion);
  check_band(study.band_hz, motion.interval(), motion.size());
  study.band_hz.first = std::max(study.band_hz.first, 2 / study.responses.duration);
  const VectorXd& f = study.responses.frequency_hz;
  study.first = std::lower_bound(f.begin(), f.end(), study.band_hz.first) - f.begin();
  study.lines = std::upper_bound(f.begin(), f.end(), study.band_hz.second) - f.begin() - study.first;
  const VectorXd lines = f.segment(study.first, study.lines);
  const MatrixXcd measured = (study.estimator == "h2" ? study.responses.h2 : study.responses.h1)
                                 .middleCols(study.first, study.lines);
  const double shift = study.responses.window_rate;
  const int order = std::min<int>(settings.largest_order, static_cast<int>(study.lines / 3) * 2 - 2);
  if (order < 4)
    throw std::invalid_argument(fmt::format("{} lines of {:.3g} Hz in the band; expected 9 at least",
                                            study.lines, 1 / study.responses.duration));
  study.orders = method->search_responses(lines, measured, shift, order);
  const bool mode_by_mode = registry.find(settings.method.name).contracts.contains(contract::mode_by_mode);
  if (mode_by_mode) {
    for (const Pole& pole : study.orders.back().poles) study.modes.push_back({pole, {}, {}, {}, {}});
  } else {
    choose_modes(settings.stabilisation, lines, measured, study);
  }
  if (study.modes.empty()) return study;
  fit_modes(lines, measured, settings.polish.value_or(!mode_by_mode), study);
  study.misfit = (measured - study.fit.reproduced).norm() / measured.norm();
  add_modes(study);
  judge_phases(study);
  return study;
}

}  // namespace beamid::experiments
