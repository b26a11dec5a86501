#include "experiments/modal/study/hammer_study.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/hammer_response.hpp"
#include "experiments/modal/hit_sampling.hpp"
#include "experiments/modal/study/record_kind.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::VectorXcd, Eigen::VectorXd;

bool is_motion(Quantity quantity) {
  return quantity == Quantity::displacement || quantity == Quantity::velocity ||
         quantity == Quantity::acceleration;
}

}  // namespace

std::optional<HammerMass> hammer_mass(const Record& record, const Pole& pole,
                                      const std::vector<Complex>& others, std::string& reason) {
  Index force = -1, motion = -1;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    if (record.channels[i].quantity == Quantity::force && force < 0) force = i;
    if (is_motion(record.channels[i].quantity) && motion < 0) motion = i;
  }
  reason = "the record holds no force beside a motion";
  if (force < 0 || motion < 0) return std::nullopt;
  reason = "a reading is missing or clipped";
  if (!record.samples.allFinite()) return std::nullopt;
  try {
    const double interval = record.interval();
    const std::vector<Hit> hits = find_hits(record.samples.row(force).transpose(), interval);
    const Hit& hit = hits.front();
    std::vector<HitSampling> sampling;
    for (const Hit& one : hits) sampling.push_back(hit_sampling(record.samples.row(force).transpose(), one));
    const double unresolved = unresolved_at_once(sampling);
    reason =
        fmt::format("its hit has {:.0f} samples above half of the largest force, too few for its momentum",
                    sampling.front().above_half);
    if (unresolved > lost_momentum) return std::nullopt;
    const Index end = hits.size() > 1 ? hits[1].onset : record.size();
    const VectorXd decay = record.samples.row(motion).segment(hit.end, end - hit.end).transpose();
    const std::vector<AmplitudePoint> points = amplitude_dependence(decay, interval, pole.rate, others);
    reason = "its decay is too short or too uncertain for two windows";
    if (points.size() < 2) return std::nullopt;
    const auto damping = [](const AmplitudePoint& p) {
      return 2 * std::numbers::pi * p.frequency_hz * p.damping_ratio;
    };
    const AmplitudePoint &first = points[0], &second = points[1];
    const double back = first.time + interval * static_cast<double>(hit.end - hit.onset);
    const double part = 0.5 * back * back / (second.time - first.time);
    const double logarithm =
        std::log(first.amplitude) + damping(first) * back + (damping(first) - damping(second)) * part;
    const double w = 2 * std::numbers::pi * first.frequency_hz, ratio = first.damping_ratio;
    const Complex s = w * Complex(-ratio, std::sqrt(1 - ratio * ratio));
    Complex transformed = 0;
    for (Index i = 0; i < hit.end; ++i)
      transformed += interval * hit.force[i] * std::exp(-s * interval * static_cast<double>(i - hit.onset));
    HammerMass found;
    const int power = times_differentiated(record.channels[motion].quantity);
    found.mass = std::pow(w, power) * std::abs(transformed) / (s.imag() * std::exp(logarithm));
    found.deviation = found.mass * std::hypot(w * (back + part) * first.damping_ratio_deviation,
                                              w * part * second.damping_ratio_deviation, unresolved);
    found.coarse = coarse_hits(sampling, interval);
    found.impulse = hit.impulse;
    found.velocity_step = hit.impulse / found.mass;
    found.pulses_s = hit.pulses_s;
    return found;
  } catch (const std::invalid_argument& error) {
    reason = error.what();
    return std::nullopt;
  }
}

namespace {

// Which poles of a hammer test's frequency responses are modes, and their least squares.

/// Sets the modes: poles that are stable over the orders, and the large peaks that none of them stands for.
/// @param lines (F) of the band [Hz]; @param measured (p x F)
void choose_modes(const StabilisationSettings& settings, const Eigen::VectorXd& lines,
                  const Eigen::MatrixXcd& measured, HammerStudy& study);

/// Sets the fit, with all poles refined together or as they are. A pole that the fit carries off by more than
/// 5 % is left out; where none is left, the modes are those at the large peaks. What happened is told by the
/// study's warnings.
void fit_modes(const Eigen::VectorXd& lines, const Eigen::MatrixXcd& measured, bool refined,
               HammerStudy& study);

// What noise and sampling leave unknown of the force that frequency responses divide by.

/// Relative errors of the averaged force (F x q): each column is one standard deviation of an error that is
/// independent of the others' and smooth over the lines. No residual shows them.
struct ForceErrors {
  /// Noise in the force window: sum_h conj(F_h) N_h / sum_h |F_h|^2, some samples that no line of the band
  /// tells apart in each column.
  Eigen::MatrixXcd noise;
  /// Aliases of the pulse (hit_sampling.hpp), in phase with it and across: the latter vanish at zero
  /// frequency, as the pulse's spectrum at the sampling rate turns by 2 pi f over half its length.
  Eigen::MatrixXcd aliases;
};

/// @param first, lines of the band
ForceErrors force_errors(const HammerResponses& responses, Eigen::Index first, Eigen::Index lines);

using Complex = std::complex<double>;

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

/// The peaks that count beside stable poles, over the largest.
constexpr double smallest_peak = 0.3;

std::vector<std::complex<double>> rates_of(const std::vector<HammerMode>& modes) {
  std::vector<std::complex<double>> rates;
  for (const HammerMode& mode : modes) rates.push_back(mode.pole.rate);
  return rates;
}

/// Those that stay where they are over the orders.
void take_stable(StabilisationSettings settings, HammerStudy& study) {
  settings.band_hz = study.band_hz;
  settings.resolution_hz = 1 / study.responses.duration;
  study.stabilisation = stabilise(study.orders, settings);
  for (const PoleCluster& cluster : study.stabilisation.modes)
    study.modes.push_back({cluster.pole, cluster.orders, {}, {}, {}});
}

/// Large peaks that no stable pole stands for: a frequency that follows the amplitude spreads its poles over
/// the orders, and none of them stays.
void add_peaks(const std::vector<Pole>& peaks, HammerStudy& study) {
  const double line = 1 / study.responses.duration;
  std::string added;
  for (const Pole& peak : peaks) {
    const double near = std::max(2 * line, 2 * std::abs(peak.rate.real()) / (2 * std::numbers::pi));
    if (std::any_of(study.modes.begin(), study.modes.end(), [&](const HammerMode& mode) {
          return std::abs(mode.pole.frequency_hz() - peak.frequency_hz()) < near;
        }))
      continue;
    study.modes.push_back({peak, {}, {}, {}, {}});
    added += fmt::format("{}{:.4g}", added.empty() ? "" : ", ", peak.frequency_hz());
  }
  if (added.empty()) return;
  std::sort(study.modes.begin(), study.modes.end(), [](const HammerMode& a, const HammerMode& b) {
    return a.pole.frequency_hz() < b.pole.frequency_hz();
  });
  study.objections.emplace_back("unstable_peak", "Peaks at " + added +
                                                     " Hz have no pole that is stable over the orders and "
                                                     "were taken from the lines around them: no sum of "
                                                     "linear modes goes through all lines there. Frequencies "
                                                     "or damping that follow the amplitude do that, "
                                                     "and a force that is not all of what acted.");
}

/// How far the fit has carried a pole, relative; more than all others where it does not decay.
double carried(const std::complex<double>& from, const std::complex<double>& to) {
  return to.real() < 0 ? std::abs(to.imag() / from.imag() - 1) : 1e3;
}

/// All poles by least squares. The one that runs away furthest goes, and the rest is fitted anew; false, and
/// all as it was, where none is left or the fit does not converge.
bool refine(const VectorXd& lines, const MatrixXcd& measured, HammerStudy& study) {
  constexpr double farthest = 0.05;
  const double shift = study.responses.window_rate;
  const ForceErrors force = force_errors(study.responses, study.first, study.lines);
  const VectorXd& spectrum = study.responses.force_spectrum;
  const ResponseNoise noise{
      {shift * study.responses.duration,
       spectrum.segment(study.first, study.lines).cwiseMax(1e-6 * spectrum.maxCoeff()).cwiseInverse()},
      force.noise,
      force.aliases};
  const HammerStudy before = study;
  try {
    while (true) {
      const std::vector<std::complex<double>> rates = rates_of(study.modes);
      ResidueFit refined = refine_poles(lines, measured, shift, study.power, rates, noise);
      std::size_t worst = 0;
      for (std::size_t m = 1; m < rates.size(); ++m)
        if (carried(rates[m], refined.rates[m]) > carried(rates[worst], refined.rates[worst])) worst = m;
      if (carried(rates[worst], refined.rates[worst]) < farthest) {
        study.fit = std::move(refined);
        return true;
      }
      const HammerMode& lost = study.modes[worst];
      const std::string why = fmt::format("the pole at {:.4g} Hz runs away", lost.pole.frequency_hz());
      if (rates.size() == 1) throw std::runtime_error(why);
      study.objections.emplace_back("spurious_pole",
                                    "Least squares of all poles: " + why + " and was excluded.");
      study.stabilisation.rejected.push_back({lost.pole, lost.orders, "runs away in the least squares"});
      study.modes.erase(study.modes.begin() + static_cast<std::ptrdiff_t>(worst));
    }
  } catch (const std::runtime_error& error) {
    study = before;
    study.objections.emplace_back(
        "no_deviations", std::string("Poles are as they were found at first, without standard deviations: ") +
                             error.what() + ".");
    return false;
  }
}

void choose_modes(const StabilisationSettings& settings, const VectorXd& lines, const MatrixXcd& measured,
                  HammerStudy& study) {
  take_stable(settings, study);
  add_peaks(poles_at_peaks(lines, measured, study.responses.window_rate, study.power, smallest_peak), study);
}

void fit_modes(const VectorXd& lines, const MatrixXcd& measured, bool refined, HammerStudy& study) {
  const double shift = study.responses.window_rate;
  const auto fit = [&] { return fit_residues(lines, measured, shift, study.power, rates_of(study.modes)); };
  study.fit = fit();
  if (!refined || refine(lines, measured, study)) return;
  HammerStudy anew = study;
  anew.modes.clear();
  anew.objections.back().text =
      "Least squares do not keep the poles that are stable over the orders; those at the peaks took their "
      "place.";
  for (const Pole& peak : poles_at_peaks(lines, measured, shift, study.power, smallest_peak))
    anew.modes.push_back({peak, {}, {}, {}, {}});
  if (!anew.modes.empty() && refine(lines, measured, anew)) study = std::move(anew);
}

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
      study.objections.emplace_back(
          "residue_phase",
          fmt::format("The residue of mode {} at {:.4g} Hz{} has a phase of {:.0f} degrees, where a real "
                      "mode has 0 or "
                      "180: its modal mass{} is not to be trusted. A near mode that was missed, a rebound or "
                      "a frequency "
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
    for (const Objection& one : records[r].objections)
      study.record_objections.emplace_back(one.name, names[r] + ": " + one.text);
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
