#include "experiments/modal/study/modal_study.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/decay_jump.hpp"
#include "experiments/modal/steady_lines.hpp"
#include "experiments/modal/study/mode_objections.hpp"
#include "experiments/modal/study/record_kind.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/signal/sway.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// What in a free decay makes its modes wrong by more than their deviations.

/// The strongest mode as the reference analysis has one, with the others between half and twice its
/// frequency.
ModalEstimate strongest_of(const std::vector<ModeEstimate>& modes, const ModeEstimate& strongest,
                           Eigen::Index channel) {
  const double frequency = strongest.pole.frequency_hz();
  ModalEstimate mode;
  mode.frequency_hz = frequency;
  mode.damping_ratio = strongest.pole.damping_ratio();
  mode.amplitude = strongest.amplitude(channel);
  for (const ModeEstimate& other : modes)
    if (const double hz = other.pole.frequency_hz();
        &other != &strongest && hz > 0.5 * frequency && hz < 2 * frequency)
      mode.companions.push_back({hz, other.pole.damping_ratio(), other.amplitude(channel)});
  return mode;
}

/// The channel in which a mode is the largest part of the motion.
Index channel_of(const ModeEstimate& mode, const Record& record) {
  Index channel = 0;
  (mode.pole.shape.cwiseAbs().array() / record.samples.rowwise().norm().array()).maxCoeff(&channel);
  return channel;
}

/// Absent where decaying modes explain the motion about it.
std::optional<AmplitudeTrend> trend_of(const ModeEstimate& mode, const RecordModes& found,
                                       const VectorXd& signal) {
  constexpr double least_left = 0.05;
  const ResidualAtMode left = &mode == &found.strongest() ? found.at_strongest : residual_at(found, mode);
  if (!left.exceeds(least_left)) return {};
  std::vector<std::complex<double>> others;
  for (const ModeEstimate& other : found.modes) others.push_back(other.pole.rate);
  try {
    return amplitude_trend(amplitude_dependence(signal, found.record.interval(), mode.pole.rate, others));
  } catch (const std::invalid_argument&) {  // too short
    return {};
  }
}

/// Sentences about modes of which frequency or damping follow the amplitude, where constant ones do not
/// explain a twentieth of the motion; the deviations of the mode are widened to hold both ends of the decay.
std::vector<Objection> amplitude_objections_to(RecordModes& found) {
  std::vector<Objection> objections;
  for (ModeEstimate& mode : found.modes) {
    const Index channel = channel_of(mode, found.record);
    const auto trend = trend_of(mode, found, found.record.samples.row(channel).transpose());
    if (!trend) continue;
    const double f = mode.pole.frequency_hz(), ratio = mode.pole.damping_ratio();
    for (const AmplitudePoint& end : {trend->first, trend->last}) {
      mode.frequency_spread_hz = std::max(mode.frequency_spread_hz, std::abs(end.frequency_hz - f));
      mode.damping_ratio_spread = std::max(mode.damping_ratio_spread, std::abs(end.damping_ratio - ratio));
    }
    objections.emplace_back(
        "amplitude_dependent",
        fmt::format(
            "The mode at {:.4g} Hz depends on its amplitude: {} as that falls from {:.3g} to {:.3g} {}. "
            "One frequency and damping ratio do not describe it; intervals are widened to hold both "
            "ends. --amplitude lists the values between; a later --window gives those of small motion.",
            f, trend->changes(), trend->first.amplitude, trend->last.amplitude,
            si_unit(found.record.channels[static_cast<std::size_t>(channel)].quantity)));
  }
  return objections;
}

/// Sentences about the strongest mode in the channel that shows it best: a jump of the motion on the way
/// (decay_jump.hpp), and the overtone of a sensor that saturates softly (amplitude_dependence.hpp), where the
/// damping ratio is wrong by more than two of its deviations through it; then those about amplitudes.
std::vector<Objection> decay_objections_to(RecordModes& found) {
  if (found.modes.empty()) return {};
  const ModeEstimate& strongest = found.strongest();
  const Record& record = found.record;
  const Index channel = channel_of(strongest, record);
  const VectorXd signal = record.samples.row(channel).transpose();
  const ModalEstimate mode = strongest_of(found.modes, strongest, channel);
  std::vector<Objection> objections;
  if (const auto jump = decay_jump(signal, record.interval(), mode))
    objections.emplace_back(
        "jump",
        jump->sentence(record.time[0]) +
            " Modes across it are wrong by more than their standard deviations. Expected a --window on one "
            "side of it.");
  constexpr double many = 2;
  const auto overtone = third_overtone(signal, record.interval(), mode);
  if (overtone && std::abs(overtone->damping_error()) * mode.damping_ratio >
                      many * strongest.pole.damping_ratio_deviation)
    objections.emplace_back(
        "overtone",
        fmt::format(
            "{} The damping ratio of the mode at {:.4g} Hz is wrong by about {:.2g} % through it, "
            "more than its standard deviation. Expected a later --window, or a sensor of larger range.",
            overtone->words(), mode.frequency_hz, 100 * std::abs(overtone->damping_error())));
  if (found.objection("no_decay")) return objections;
  for (Objection& one : amplitude_objections_to(found)) objections.push_back(std::move(one));
  return objections;
}

/// Shapes in the channels' units: least squares of all modes to what they are to reproduce.
void add_shapes(const VectorXd& scales, RecordModes& found) {
  found.reproduced.resize(0, 0);
  if (found.modes.empty()) return;
  std::vector<std::complex<double>> rates;
  for (const ModeEstimate& mode : found.modes) rates.push_back(mode.pole.rate);
  rates.emplace_back(0);
  std::vector<bool> oscillating(rates.size(), true);
  oscillating.back() = false;
  const ShapeFit fit = fit_shapes(found.target, found.interval, rates, oscillating);
  found.reproduced = fit.reconstruction;
  for (std::size_t m = 0; m < found.modes.size(); ++m) {
    Pole& pole = found.modes[m].pole;
    // An autocorrelation begins at a lag of dt: its part is brought back to none.
    const std::complex<double> back = found.free_decay ? 1.0 : std::exp(-pole.rate * found.interval);
    const Eigen::VectorXcd part = back * fit.shapes.col(static_cast<Index>(m));
    if (found.free_decay) {
      pole.shape = part;
    } else {  // an autocorrelation's part is the square of a root mean square; phases are the shape's
      Eigen::VectorXcd shape = scales.asDiagonal() * pole.shape;
      for (Index i = 0; i < shape.size(); ++i)
        shape[i] = std::polar(std::sqrt(std::max(0.0, part[i].real())), std::arg(shape[i]));
      pole.shape = shape;
    }
    double squares = 0;
    for (Index i = 0; i < part.size(); ++i)
      squares += found.free_decay ? std::norm(part[i] / scales[i])
                                  : std::pow(std::max(0.0, part[i].real()) / (scales[i] * scales[i]), 2);
    found.modes[m].strength = std::sqrt(squares);
  }
}

void leave_out_weak(const ModalStudySettings& settings, RecordModes& found) {
  double strongest = 0;
  for (const ModeEstimate& mode : found.modes) strongest = std::max(strongest, mode.strength);
  double floor = settings.smallest_amplitude * strongest;
  std::string why =
      fmt::format("amplitude below {:.2g} % of the strongest", 100 * settings.smallest_amplitude);
  if (settings.modes > 0 && static_cast<std::size_t>(settings.modes) < found.modes.size()) {
    std::vector<double> strengths;
    for (const ModeEstimate& mode : found.modes) strengths.push_back(mode.strength);
    std::sort(strengths.rbegin(), strengths.rend());
    if (strengths[settings.modes - 1] > floor) {
      floor = strengths[settings.modes - 1];
      why = fmt::format("weaker than the {} requested", settings.modes);
    }
  }
  for (const ModeEstimate& mode : found.modes)
    if (mode.strength < floor) found.stabilisation.rejected.push_back({mode.pole, mode.orders, why});
  std::erase_if(found.modes, [&](const ModeEstimate& mode) { return mode.strength < floor; });
}

/// Those that the method gives, and what it refused, within the band.
void take_modes(RecordModes& found) {
  const auto inside = [&](const Pole& pole) {
    return pole.frequency_hz() >= found.band_hz.first && pole.frequency_hz() <= found.band_hz.second;
  };
  for (const OrderPoles& order : found.search.orders)
    for (const Pole& pole : order.poles)
      if (inside(pole)) found.modes.push_back({pole, {}});
  for (const RefusedPole& refused : found.search.refused)
    if (inside(refused.pole)) found.stabilisation.rejected.push_back({refused.pole, {}, refused.reason});
  found.remarks.insert(found.remarks.end(), found.search.remarks.begin(), found.search.remarks.end());
  found.objections.insert(found.objections.end(), found.search.objections.begin(),
                          found.search.objections.end());
}

/// A method for decays wants one, a method for random vibration a steady record. A slow decay loses little
/// over a record, and two near modes can be stronger late: what decaying modes reproduce is a decay.
void check_kind(const Record& whole, const MatrixXd& samples, RecordModes& found) {
  constexpr double reproduced = 0.5;  // of the motion's size, the residual
  const MatrixXd motion = samples.colwise() - samples.rowwise().mean();
  const Index half = motion.cols() / 2;
  const double early = motion.leftCols(half).squaredNorm(), late = motion.rightCols(half).squaredNorm();
  const double residual = found.reproduced.size() > 0 ? (found.target - found.reproduced).norm()
                                                      : std::numeric_limits<double>::infinity();
  const bool decays = (found.polished && !found.modes.empty()) || residual < reproduced * motion.norm();
  found.decays = decays || !found.free_decay;
  if (found.free_decay && !decays && late > 0.7 * early)
    found.objections.emplace_back(
        "no_decay",
        "The record does not decay: its second half is nearly as strong as its first, and no decaying modes "
        "reproduce it. For random vibration take --method ssi_cov; for a decay that comes later in the "
        "record, --window.");
  else if (found.free_decay)
    object_to_decay(whole, found);
  found.steady = found.free_decay || std::max(early, late) <= 10 * std::min(early, late);
  if (!found.steady)
    found.objections.emplace_back(
        "unsteady",
        "The record is not steady: one half is much stronger than the other. For a free decay take --method "
        "era; for random vibration, a --window without the strong part.");
  constexpr double most_left = 0.5;  // of the autocorrelations
  if (!found.free_decay && !found.modes.empty() && found.left() > most_left)
    found.objections.emplace_back(
        "unexplained_motion",
        fmt::format(
            "The modes do not explain {:.2g} % of the autocorrelations: the strongest motion is none of "
            "theirs. A longer record, another --order or --band may show its mode; a record without "
            "a structure has none.",
            100.0 * found.left()),
        found.left(), most_left);
}

/// Where there is no mode at all there is no answer.
void state_no_mode(RecordModes& found) {
  if (!found.modes.empty()) return;
  found.objections.emplace_back(
      "no_mode",
      found.is_steady_sine() ? "No mode: the record is a steady sine, which has no decay and no damping "
                               "ratio. Record a release, a hit or random vibration with the machine at rest."
      : found.mode_by_mode
          ? "No mode: no peak of the spectrum gave one. Another --band or --window may show one; a sensor or "
            "a record without a structure's motion has none."
          : "No mode: no pole is both stable over the model orders and confirmed. Another --band, --window "
            "or --order may show one; a sensor or a record without a structure's motion has none.",
      0.0, 1.0);
}

/// Of random vibration: sines that last are no mode's, and next to one they draw it to themselves.
/// @returns their frequencies [Hz]
std::vector<double> take_lines_out(const VectorXd& scales, CoarseRecord& coarse, RecordModes& found) {
  const SteadyLines steady =
      steady_lines(scales.cwiseInverse().asDiagonal() * coarse.samples, found.interval);
  if (steady.lines.empty()) return {};
  coarse.samples = scales.asDiagonal() * steady.rest;
  std::vector<double> frequencies;
  double squares = 0.0;
  for (const SteadyLine& line : steady.lines) {
    frequencies.push_back(line.frequency_hz);
    squares += line.share * line.share;
  }
  constexpr double almost_all = 0.9;  // of the motion's root mean square
  const bool several = frequencies.size() > 1;
  found.objections.emplace_back(
      "steady_line",
      fmt::format("{} at {}, {:.2g} % of the motion's root mean square, {} over the whole record, as no mode "
                  "does that is shaken at random: a machine or the mains. {} before modes were sought.",
                  several ? "Lines" : "A line", frequencies_text(frequencies), 100.0 * std::sqrt(squares),
                  several ? "last" : "lasts", several ? "They were taken out" : "It was taken out"),
      std::sqrt(squares), almost_all);
  return frequencies;
}

/// Where a line was taken out of random vibration, what remains of it is no mode: one within a hundredth of
/// its frequency whose damping ratio is not determined.
void reject_modes_at_lines(const std::vector<double>& lines_hz, RecordModes& found) {
  constexpr double near = 0.01;
  const auto remains = [&](const ModeEstimate& mode) {
    const Pole& pole = mode.pole;
    return !(2 * pole.damping_ratio_deviation < pole.damping_ratio()) &&
           std::any_of(lines_hz.begin(), lines_hz.end(), [&](double line_hz) {
             return std::abs(line_hz - pole.frequency_hz()) < near * line_hz;
           });
  };
  for (const ModeEstimate& mode : found.modes)
    if (remains(mode))
      found.stabilisation.rejected.push_back(
          {mode.pole, mode.orders, "remains of a line that was taken out"});
  std::erase_if(found.modes, remains);
}

/// What the record shows and no mode stands for: lines outside the band, and lines inside it.
void name_missed_lines(const std::vector<RecordLine>& lines, RecordModes& found) {
  std::vector<double> outside, missed, followed;
  const auto near = [](const RecordLine& line, const Pole& pole) {
    return std::abs(pole.frequency_hz() - line.frequency_hz) <
           std::max(line.resolution_hz, 0.03 * line.frequency_hz);
  };
  for (const RecordLine& line : lines) {
    const bool inside = line.frequency_hz >= found.band_hz.first && line.frequency_hz <= found.band_hz.second;
    const auto& rejected = found.stabilisation.rejected;
    if (!inside)
      outside.push_back(line.frequency_hz);
    else if (std::none_of(found.modes.begin(), found.modes.end(),
                          [&](const ModeEstimate& mode) { return near(line, mode.pole); }) &&
             std::none_of(rejected.begin(), rejected.end(), [&](const PoleCluster& cluster) {
               return cluster.objection.starts_with("overtone") && near(line, cluster.pole);
             }))
      (found.free_decay && followed_multiple(found, line.frequency_hz) > 0 ? followed : missed)
          .push_back(line.frequency_hz);
  }
  if (!followed.empty())
    found.objections.emplace_back(
        "overtone_mode",
        fmt::format(
            "{} at {} {} a multiple of {:.4g} Hz and {} its amplitude and phase: an overtone, no mode. "
            "Stiffness, clamp or sensor are not linear at these amplitudes.",
            followed.size() > 1 ? "Lines" : "The line", frequencies_text(followed),
            followed.size() > 1 ? "are each" : "is", found.strongest().pole.frequency_hz(),
            followed.size() > 1 ? "follow" : "follows"));
  if (!outside.empty())
    found.objections.emplace_back(
        "lines", fmt::format("{} at {} {} outside this band; --band takes {} in.",
                             outside.size() > 1 ? "Lines" : "A line", frequencies_text(outside),
                             outside.size() > 1 ? "lie" : "lies", outside.size() > 1 ? "them" : "it"));
  if (!missed.empty())
    found.objections.emplace_back(
        "lines",
        fmt::format("No mode stands for the {} at {}; another --band, --window or --order may show one.",
                    missed.size() > 1 ? "lines" : "line", frequencies_text(missed)));
}

}  // namespace

double RecordModes::left() const {
  return reproduced.size() > 0 ? (target - reproduced).norm() / target.norm() : 1.0;
}

const Objection* RecordModes::objection(const std::string& kind) const {
  const auto at = std::ranges::find(objections, kind, &Objection::name);
  return at == objections.end() ? nullptr : &*at;
}

bool RecordModes::is_steady_sine() const {
  const Objection* const line = objection("steady_line");
  return line && line->statistic > line->limit;
}

const ModeEstimate& RecordModes::strongest() const {
  return *std::max_element(modes.begin(), modes.end(), [](const ModeEstimate& a, const ModeEstimate& b) {
    return a.strength < b.strength;
  });
}

RecordModes find_modes(const std::string& name, const Record& record, bool windowed,
                       const ModalStudySettings& settings) {
  const auto& registry = modal_method_registry();
  RecordModes found;
  found.name = name;
  found.remarks = record.remarks;
  found.free_decay = registry.find(settings.method.name).contracts.contains(contract::free_decay);
  found.mode_by_mode = registry.find(settings.method.name).contracts.contains(contract::mode_by_mode);
  Record whole = complete_part(motion_of(record), found.remarks);
  std::vector<RecordLine> lines;
  std::optional<double> drift_period;
  if (found.free_decay)
    drift_period = take_decay(record, windowed, whole, lines, found);
  else
    check_intervals(found.record = whole);
  const double interval = found.record.interval();
  const VectorXd scales = scales_of(found.record);
  found.band_hz = settings.band_hz ? *settings.band_hz : decay_band(found.record.samples, interval, lines);
  check_band(found.band_hz, interval, found.record.size());

  CoarseRecord coarse = coarse_record(found.record, found.band_hz.second);
  found.interval = coarse.last.interval;
  found.start = found.record.time[0] + coarse.last.start;
  std::vector<double> steady_hz;
  if (!found.free_decay) steady_hz = take_lines_out(scales, coarse, found);
  const auto method = registry.make(settings.method.name, settings.method.options);
  if (found.mode_by_mode) {
    found.search = method->search(scales.cwiseInverse().asDiagonal() * coarse.samples, found.interval,
                                  settings.largest_order);
    take_modes(found);
  } else {
    search_levels(*method, settings, scales, lines, coarse, found);
  }

  found.target =
      found.free_decay ? coarse.samples : MatrixXd(scales.cwiseAbs2().asDiagonal() * found.search.decays);
  reject_modes_at_lines(steady_hz, found);
  add_shapes(scales, found);
  leave_out_weak(settings, found);
  if (settings.polish.value_or(found.free_decay && !found.mode_by_mode)) {
    if (!found.free_decay)
      throw std::invalid_argument("--polish fits a free decay; method " + settings.method.name +
                                  " takes the record for random vibration");
    polish(found, settings.stabilisation);
  }
  add_shapes(scales, found);
  if (found.free_decay) {
    set_overtones_aside(found);
    add_shapes(scales, found);
  }
  check_kind(whole, coarse.samples, found);
  state_no_mode(found);
  name_missed_lines(lines, found);
  if (found.free_decay) {
    for (ModeEstimate& mode : found.modes)  // back to the undecimated record and its beginning
      mode.pole.shape *=
          std::exp(-mode.pole.rate * coarse.last.start) / coarse.last.response(mode.pole.rate) /
          (drift_period ? response_without_sway(mode.pole.rate, interval, *drift_period) : 1.0);
    for (Objection& one : decay_objections_to(found)) found.objections.push_back(std::move(one));
  }
  for (ModeEstimate& mode : found.modes) {
    Pole& pole = mode.pole;
    pole.frequency_deviation_hz = std::hypot(pole.frequency_deviation_hz, mode.frequency_spread_hz);
    pole.damping_ratio_deviation = std::hypot(pole.damping_ratio_deviation, mode.damping_ratio_spread);
  }
  return found;
}

}  // namespace beamid::experiments
