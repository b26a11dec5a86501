#include "experiments/modal/study/modal_study.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
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
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

// Whether what a decay's modes leave is the same motion going on.

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr int resolutions_beside = 3;  // resolutions

/// Power of all channels at a frequency under a Hann window.
double windowed_power(const MatrixXd& samples, double interval, double frequency_hz) {
  const Index count = samples.cols();
  Eigen::VectorXcd wave(count);
  for (Index k = 0; k < count; ++k) {
    const double t = static_cast<double>(k), turn = 2.0 * std::numbers::pi;
    wave[k] = std::polar(0.5 - 0.5 * std::cos(turn * (t + 0.5) / static_cast<double>(count)),
                         -turn * frequency_hz * interval * t);
  }
  return (samples.cast<std::complex<double>>() * wave).squaredNorm();
}

/// Mean power about a frequency.
double power_about(const MatrixXd& samples, double interval, double frequency_hz) {
  const double step = 1.0 / (interval * static_cast<double>(samples.cols()));
  double sum = 0.0;
  for (int k = -resolutions_beside; k <= resolutions_beside; ++k)
    sum += windowed_power(samples, interval, frequency_hz + k * step);
  return sum / (2 * resolutions_beside + 1);
}

double median_power(const MatrixXd& samples, double interval, std::pair<double, double> band_hz) {
  constexpr int fewest = 20, most = 200;
  const double resolutions =
      (band_hz.second - band_hz.first) * interval * static_cast<double>(samples.cols());
  const int count = std::clamp(static_cast<int>(resolutions), fewest, most);
  std::vector<double> powers;
  for (int k = 0; k < count; ++k)
    powers.push_back(windowed_power(samples, interval,
                                    band_hz.first + (k + 0.5) / count * (band_hz.second - band_hz.first)));
  return median(powers);
}

double motion_size_of(const MatrixXd& samples) {
  return (samples.colwise() - samples.rowwise().mean()).norm();
}

/// Whether the motion of some periods is larger than that of some before.
bool motion_rises(const MatrixXd& motion, Index part) {
  constexpr double larger = 1.2;
  if (part < 4) return true;
  double least = motion_size_of(motion.leftCols(std::min(part, motion.cols())));
  for (Index at = part; at + part <= motion.cols(); at += part) {
    const double size = motion_size_of(motion.middleCols(at, part));
    if (size > larger * least) return true;
    least = std::min(least, size);
  }
  return false;
}

Index samples_in_periods(double periods, const ModeEstimate& mode, double interval) {
  return static_cast<Index>(periods / (mode.pole.frequency_hz() * interval));
}

/// Modes of a free decay leave noise, or, where frequency and damping follow the amplitude, motion that dies
/// out with them. Under loads that go on they leave motion at their own frequencies to the end, and it rises
/// at times. So: they leave more than 15 % of the motion; some four periods of it are 1.2 times as large as
/// four before; and at one of them, in the second half of `target` - `reproduced`, the power within three
/// resolutions to either side is 10 times the band's median, and a quarter of the first half's or more. (Of
/// white noise the mean of 7 powers reaches 10 medians with probability 1e-13.)
bool motion_goes_on(const RecordModes& found) {
  constexpr double least_left = 0.15, above_median = 10.0, as_early = 0.25;
  if (found.reproduced.size() == 0 || found.modes.empty()) return false;
  const MatrixXd left = found.target - found.reproduced;
  const MatrixXd motion = found.target.colwise() - found.target.rowwise().mean();
  if (left.norm() < least_left * motion.norm() ||
      !motion_rises(motion, samples_in_periods(4.0, found.strongest(), found.interval)))
    return false;
  const MatrixXd early = left.leftCols(left.cols() / 2), late = left.rightCols(left.cols() / 2);
  const double usual = median_power(late, found.interval, found.band_hz);
  return std::any_of(found.modes.begin(), found.modes.end(), [&](const ModeEstimate& mode) {
    const double f = mode.pole.frequency_hz(), power = power_about(late, found.interval, f);
    return power > above_median * usual && power > as_early * power_about(early, found.interval, f);
  });
}

/// Whether a record whose largest reading stands in its second half, from where on it was taken for a decay,
/// moves nearly as much in two periods of the strongest mode before as in two after: a hit or a release
/// begins at once, random vibration comes to its largest and goes.
bool moved_before(const Record& whole, const RecordModes& found) {
  constexpr double as_much = 0.7;
  if (found.modes.empty()) return false;
  const Index before =
      std::lower_bound(whole.time.begin(), whole.time.end(), found.record.time[0]) - whole.time.begin();
  if (before <= found.record.size()) return false;
  const Index part =
      std::min(found.record.size(), samples_in_periods(2.0, found.strongest(), whole.interval()));
  if (part < 2 || part > before) return false;
  return motion_size_of(whole.samples.middleCols(before - part, part)) >
         as_much * motion_size_of(whole.samples.middleCols(before, part));
}

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

/// Sentences about the strongest mode in the channel that shows it best: a jump of the motion on the way
/// (decay_jump.hpp), and the overtone of a sensor that saturates softly (amplitude_dependence.hpp), where the
/// damping ratio is wrong by more than two of its deviations through it.
std::vector<Objection> decay_objections_to(const RecordModes& found) {
  if (found.modes.empty()) return {};
  const ModeEstimate& strongest = found.strongest();
  const Record& record = found.record;
  Eigen::Index channel = 0;
  (strongest.pole.shape.cwiseAbs().array() / record.samples.rowwise().norm().array()).maxCoeff(&channel);
  const Eigen::VectorXd signal = record.samples.row(channel).transpose();
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
  return objections;
}

/// Rows over the root mean square of all channels of their quantity.
VectorXd scales_of(const Record& record) {
  std::map<Quantity, std::pair<double, double>> squares;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    auto& [sum, count] = squares[record.channels[i].quantity];
    sum += (record.samples.row(i).array() - record.samples.row(i).mean()).square().sum();
    count += static_cast<double>(record.size());
  }
  VectorXd scales(record.samples.rows());
  for (Index i = 0; i < scales.size(); ++i) {
    const auto& [sum, count] = squares[record.channels[i].quantity];
    scales[i] = sum > 0 ? std::sqrt(sum / count) : 1;
  }
  return scales;
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
  constexpr const char* no_decay =
      "Standard deviations are too small. For random vibration take --method ssi_cov or bayoma and a record "
      "of many "
      "decay times; for a decay, a --window of it alone.";
  constexpr double reproduced = 0.5, mostly = 0.3;  // of the motion's size, the residual
  const MatrixXd motion = samples.colwise() - samples.rowwise().mean();
  const Index half = motion.cols() / 2;
  const double early = motion.leftCols(half).squaredNorm(), late = motion.rightCols(half).squaredNorm();
  const double residual = found.reproduced.size() > 0 ? (found.target - found.reproduced).norm()
                                                      : std::numeric_limits<double>::infinity();
  const bool decays = (found.polished && !found.modes.empty()) ||
                      residual<reproduced * motion.norm(), is_as_strong_late = late> 0.7 * early;
  const std::size_t before = found.objections.size();
  if (found.free_decay && !decays && is_as_strong_late)
    found.objections.emplace_back(
        "no_decay",
        "The record does not decay: its second half is nearly as strong as its first, and no decaying modes "
        "reproduce it. For random vibration take --method ssi_cov; for a decay that comes later in the "
        "record, --window.");
  else if (found.free_decay && motion_goes_on(found))
    found.objections.emplace_back(
        "no_decay",
        fmt::format("The motion goes on: the modes do not explain {:.2g} % of it, at their own frequencies "
                    "and to the end, which no decay does. {}",
                    100.0 * residual / motion.norm(), no_decay));
  else if (found.free_decay && moved_before(whole, found))
    found.objections.emplace_back(
        "no_decay",
        fmt::format("No release was found: the record moves as much before its largest reading, at {:.4g} s, "
                    "as after. {}",
                    found.record.time[0], no_decay));
  // What decaying modes reproduce for the most part is a decay, whatever goes on beside it.
  found.decays =
      found.objections.size() == before || (residual < mostly * motion.norm() && !is_as_strong_late);
  found.steady = found.free_decay || std::max(early, late) <= 10 * std::min(early, late);
  if (!found.steady)
    found.objections.emplace_back(
        "unsteady",
        "The record is not steady: one half is much stronger than the other. For a free decay take --method "
        "era; for random vibration, a --window without the strong part.");
}

/// Of random vibration: sines that last are no mode's, and next to one they draw it to themselves.
void take_lines_out(const VectorXd& scales, CoarseRecord& coarse, RecordModes& found) {
  const SteadyLines steady =
      steady_lines(scales.cwiseInverse().asDiagonal() * coarse.samples, found.interval);
  if (steady.lines.empty()) return;
  coarse.samples = scales.asDiagonal() * steady.rest;
  std::vector<double> frequencies;
  double squares = 0.0;
  for (const SteadyLine& line : steady.lines) {
    frequencies.push_back(line.frequency_hz);
    squares += line.share * line.share;
  }
  const bool several = frequencies.size() > 1;
  found.objections.emplace_back(
      "steady_line",
      fmt::format("{} at {}, {:.2g} % of the motion's root mean square, {} over the whole record, as no mode "
                  "does that is shaken at random: a machine or the mains. {} before modes were sought.",
                  several ? "Lines" : "A line", frequencies_text(frequencies), 100.0 * std::sqrt(squares),
                  several ? "last" : "lasts", several ? "They were taken out" : "It was taken out"));
}

/// What the record shows and no mode stands for: lines outside the band, and lines inside it.
void name_missed_lines(const std::vector<RecordLine>& lines, RecordModes& found) {
  std::vector<double> outside, missed;
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
      missed.push_back(line.frequency_hz);
  }
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
  found.record = complete_part(motion_of(record), found.remarks);
  const Record whole = found.record;
  if (found.free_decay && !windowed) found.record = from_release(found.record, record, found.remarks);
  check_intervals(found.record);
  const double interval = found.record.interval();
  const VectorXd scales = scales_of(found.record);
  std::vector<RecordLine> lines;
  if (found.free_decay)
    lines = record_lines(scales.cwiseInverse().asDiagonal() * found.record.samples, interval);
  found.band_hz = settings.band_hz ? *settings.band_hz : decay_band(found.record.samples, interval, lines);
  check_band(found.band_hz, interval, found.record.size());

  CoarseRecord coarse = coarse_record(found.record, found.band_hz.second);
  found.interval = coarse.last.interval;
  found.start = found.record.time[0] + coarse.last.start;
  if (!found.free_decay) take_lines_out(scales, coarse, found);
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
  name_missed_lines(lines, found);
  if (found.free_decay) {
    for (ModeEstimate& mode : found.modes)  // back to the undecimated record and its beginning
      mode.pole.shape *= std::exp(-mode.pole.rate * coarse.last.start) / coarse.last.response(mode.pole.rate);
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
