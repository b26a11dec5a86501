#include "experiments/modal/study/record_kind.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/modal/hammer_response.hpp"
#include "experiments/modal/mode_by_mode.hpp"
#include "experiments/signal/onsets.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

VectorXd distance_from_median(const VectorXd& signal) {
  return (signal.array() - median(signal)).abs();
}

/// Pulses or steps of a table, far above its noise.
bool has_pulses(const VectorXd& signal) {
  constexpr double smallest = 0.05, noise = 10.0;  // of the largest; median deviations
  constexpr Index fewest = 4;                      // samples
  const VectorXd size = distance_from_median(signal);
  return (size.array() > std::max(smallest * size.maxCoeff(), noise * median(size))).count() >= fewest;
}

}  // namespace

bool is_struck(const Record& record) {
  constexpr double most_active = 0.2;
  constexpr std::size_t fewest_hits = 2;
  Index force = -1;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    const Quantity quantity = record.channels[static_cast<std::size_t>(i)].quantity;
    if (!is_input(quantity)) continue;
    if (quantity != Quantity::force || force >= 0) return false;
    force = i;
  }
  if (force < 0 || !record.samples.row(force).allFinite()) return false;
  const VectorXd signal = record.samples.row(force).transpose();
  if (excursions_of(signal).share > most_active) return false;
  try {
    return find_hits(signal, record.interval()).size() >= fewest_hits;
  } catch (const std::invalid_argument&) {  // no hit
    return false;
  }
}

bool is_driven(const Record& record) {
  constexpr double least_active = 0.03;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    const Quantity quantity = record.channels[static_cast<std::size_t>(i)].quantity;
    if (!is_input(quantity)) continue;
    const VectorXd signal = record.samples.row(i).transpose();
    if (!signal.allFinite()) continue;
    if (excursions_of(signal).share > least_active || (quantity != Quantity::force && has_pulses(signal)))
      return true;
  }
  return false;
}

void put_strongest_first(Record& record) {
  std::vector<Index> outputs;
  for (Index i = 0; i < record.samples.rows(); ++i)
    if (!is_input(record.channels[static_cast<std::size_t>(i)].quantity)) outputs.push_back(i);
  if (outputs.size() < 2) return;
  const auto channel = [&](Index row) -> Channel& { return record.channels[static_cast<std::size_t>(row)]; };
  const auto size = [&](Index row) {
    const Eigen::ArrayXd signal = record.samples.row(row).transpose().array();
    const double count = std::max<double>(1.0, static_cast<double>(signal.isFinite().count())),
                 mean = signal.isFinite().select(signal, 0.0).sum() / count;
    return signal.isFinite().select((signal - mean).square(), 0.0).sum() / count;
  };
  Index strongest = outputs.front();
  for (const Index row : outputs)
    if (channel(row).quantity == channel(outputs.front()).quantity && size(row) > size(strongest))
      strongest = row;
  record.remarks.push_back(
      fmt::format("Of {} channels '{}' moves most: it is followed. --column follows another.", outputs.size(),
                  channel(strongest).name));
  std::swap(channel(outputs.front()), channel(strongest));
  record.samples.row(outputs.front()).swap(record.samples.row(strongest));
}

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

std::vector<RecordLine> record_lines(const Eigen::MatrixXd& samples, double interval) {
  constexpr Index fewest = 128;
  constexpr LineSettings line{.above_noise = 6, .above_valley = 2, .least = 0.02};
  std::vector<RecordLine> found;
  for (Index count = samples.cols(); count >= std::min(fewest, samples.cols()); count /= 4) {
    double strongest = 0, resolution = 2 / (interval * static_cast<double>(count));
    const auto lines = count == samples.cols() ? spectral_lines(samples, interval, line)
                                               : spectral_lines(samples.leftCols(count), interval, line);
    for (const SpectralLine& one : lines) strongest = std::max(strongest, one.amplitude);
    for (const SpectralLine& one : lines) {
      const auto known = std::find_if(found.begin(), found.end(), [&](const RecordLine& other) {
        return std::abs(other.frequency_hz - one.frequency_hz) < resolution;
      });
      const double share = one.amplitude / strongest;
      if (known == found.end())
        found.push_back({one.frequency_hz, resolution, share});
      else
        known->share = std::max(known->share, share);
    }
    if (count < 4) break;
  }
  std::sort(found.begin(), found.end(),
            [](const RecordLine& a, const RecordLine& b) { return a.frequency_hz < b.frequency_hz; });
  return found;
}

std::string frequencies_text(const std::vector<double>& frequencies_hz) {
  constexpr std::size_t most = 6;
  const std::size_t shown = std::min(most, frequencies_hz.size());
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == frequencies_hz.size();
    text += fmt::format("{}{:.4g}", i == 0 ? "" : last ? " and " : ", ", frequencies_hz[i]);
  }
  text += " Hz";
  if (shown < frequencies_hz.size()) text += fmt::format(" and {} more", frequencies_hz.size() - shown);
  return text;
}

namespace {

constexpr double margin = 1.3, highest = 0.45;

}  // namespace

std::pair<double, double> signal_band(const Eigen::MatrixXd& samples, double interval) {
  constexpr double least = 0.05;
  const double lowest = 2 / (interval * static_cast<double>(samples.cols()));
  double top = 2 * lowest;
  for (Eigen::Index i = 0; i < samples.rows(); ++i) {
    const AmplitudeSpectrum spectrum = amplitude_spectrum(samples.row(i).transpose(), interval);
    double peak = 0;
    for (Eigen::Index k = 0; k < spectrum.amplitude.size(); ++k)
      if (spectrum.frequency_hz[k] >= lowest) peak = std::max(peak, spectrum.amplitude[k]);
    for (Eigen::Index k = spectrum.amplitude.size() - 1; k >= 0; --k)
      if (spectrum.amplitude[k] >= least * peak) {
        top = std::max(top, margin * spectrum.frequency_hz[k]);
        break;
      }
  }
  return {lowest, std::min(top, highest / interval)};
}

std::pair<double, double> decay_band(const Eigen::MatrixXd& samples, double interval,
                                     const std::vector<RecordLine>& lines) {
  std::pair<double, double> band = signal_band(samples, interval);
  for (const RecordLine& line : lines) band.second = std::max(band.second, margin * line.frequency_hz);
  band.second = std::min(band.second, highest / interval);
  return band;
}

void check_band(std::pair<double, double> band_hz, double interval, Eigen::Index count) {
  constexpr Eigen::Index fewest = 16;
  if (count < fewest)
    throw std::invalid_argument(
        fmt::format("a record of {} samples; modal analysis expects {} at least", count, fewest));
  const auto [from, to] = band_hz;
  if (from >= 0 && from < to && to < 0.5 / interval && to * interval * static_cast<double>(count) > 2) return;
  throw std::invalid_argument(fmt::format(
      "band {:g} to {:g} Hz; expected 0 <= from < to, and to between {:.4g} Hz, two cycles in the "
      "record, and {:.6g} Hz, half its sampling rate",
      from, to, 2 / (interval * static_cast<double>(count)), 0.5 / interval));
}

namespace {

int factor_for(const Record& record, double highest_hz) {
  constexpr double passed = 0.3;  // of the new sampling rate, untouched by the decimation
  return decimation_factor(passed / (record.interval() * highest_hz), record.size() / 100);
}

/// Where a level that reaches up to `top` ends: at an eighth of it, away from any line, or at the band's own
/// beginning.
double bottom_of(double top, const std::vector<RecordLine>& lines, const RecordModes& found) {
  constexpr double span = 8, margin = 1.15;
  double bottom = top / span;
  const auto beside = [&](const RecordLine& line) {
    return line.frequency_hz < margin * bottom && line.frequency_hz > bottom / margin;
  };
  while (std::any_of(lines.begin(), lines.end(), beside)) bottom /= margin;
  const bool needed = std::any_of(lines.begin(), lines.end(), [&](const RecordLine& line) {
    return line.frequency_hz >= found.band_hz.first && line.frequency_hz < bottom;
  });
  return needed && factor_for(found.record, bottom) > factor_for(found.record, top) ? bottom
                                                                                    : found.band_hz.first;
}

void choose(StabilisationSettings settings, const std::vector<OrderPoles>& orders, RecordModes& found) {
  const Stabilisation level = stabilise(orders, settings);
  const auto append = [](auto& to, const auto& from) { to.insert(to.begin(), from.begin(), from.end()); };
  append(found.stabilisation.poles, level.poles);
  append(found.stabilisation.modes, level.modes);
  append(found.stabilisation.rejected, level.rejected);
}

}  // namespace

CoarseRecord coarse_record(const Record& record, double highest_hz) {
  CoarseRecord coarse;
  const int factor = factor_for(record, highest_hz);
  for (Index i = 0; i < record.samples.rows(); ++i) {
    coarse.last = decimate(record.samples.row(i).transpose(), record.interval(), factor);
    if (i == 0) coarse.samples.resize(record.samples.rows(), coarse.last.samples.size());
    coarse.samples.row(i) = coarse.last.samples.transpose();
  }
  return coarse;
}

void search_levels(const ModalMethod& method, const ModalStudySettings& settings, const VectorXd& scales,
                   const std::vector<RecordLine>& lines, const CoarseRecord& finest, RecordModes& found) {
  CoarseRecord level = finest;
  double top = found.band_hz.second;
  for (bool first = true;; first = false) {
    PoleSearch search = method.search(scales.cwiseInverse().asDiagonal() * level.samples, level.last.interval,
                                      settings.largest_order);
    const double bottom = found.free_decay ? bottom_of(top, lines, found) : found.band_hz.first;
    StabilisationSettings stable = settings.stabilisation;
    stable.band_hz = {bottom, top};
    if (found.free_decay)
      stable.resolution_hz = 1 / (level.last.interval * static_cast<double>(level.samples.cols()));
    choose(stable, search.orders, found);
    if (first) found.search = std::move(search);
    if (bottom <= found.band_hz.first) break;
    level = coarse_record(found.record, bottom);
    top = bottom;
  }
  for (const PoleCluster& cluster : found.stabilisation.modes)
    found.modes.push_back({cluster.pole, cluster.orders});
}

namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr Index fewest_decay_samples = 64;

}  // namespace

Record part_of(const Record& record, Index begin, Index count) {
  Record part = record;
  part.time = record.time.segment(begin, count).eval();
  part.samples = record.samples.middleCols(begin, count).eval();
  return part;
}

Record motion_of(const Record& record) {
  Record motion = record;
  motion.channels.clear();
  Index rows = 0;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    if (is_input(record.channels[i].quantity)) continue;
    motion.samples.row(rows++) = record.samples.row(i);
    motion.channels.push_back(record.channels[i]);
  }
  motion.samples.conservativeResize(rows, Eigen::NoChange);
  if (rows == 0)
    throw std::invalid_argument(
        "modal analysis needs a channel of motion or strain; the record has forces only");
  return motion;
}

Record complete_part(const Record& record, std::vector<std::string>& remarks) {
  if (record.samples.allFinite()) return record;
  Index begin = 0, longest = 0, missing = 0;
  for (Index k = 0, run = 0; k < record.size(); ++k) {
    const bool complete = record.samples.col(k).allFinite();
    run = complete ? run + 1 : 0;
    missing += !complete;
    if (run > longest) longest = run, begin = k + 1 - run;
  }
  if (longest < fewest_decay_samples)
    throw std::invalid_argument(
        fmt::format("{} of {} readings are missing or clipped, and the longest part without one, from {:.6g} "
                    "s, has {} samples; modal analysis expects {} at least",
                    missing, record.size(), record.time[std::min(begin, record.size() - 1)], longest,
                    fewest_decay_samples));
  remarks.push_back(fmt::format(
      "{} of {} readings are missing or clipped: the longest part without one is taken, {} to {} s.", missing,
      record.size(), instant_text(record.time[begin]), instant_text(record.time[begin + longest - 1])));
  return part_of(record, begin, longest);
}

namespace {

/// Samples at which a channel that was at rest is hit, where it is more than once: it doubles within
/// two periods, to a fifth of its largest deviation. Beats rise over many periods.
std::vector<Index> hits_of(const VectorXd& signal, double interval) {
  constexpr Index fewest = 16;
  if (signal.size() < fewest || !(signal.maxCoeff() > signal.minCoeff())) return {};
  const double period = 1.0 / strongest_frequency(signal, interval);
  const Onsets found = find_onsets(signal, interval, {.smallest = 0.2, .rise = 2.0, .apart = 2.0 * period});
  return found.samples.size() > 1 ? found.samples : std::vector<Index>{};
}

/// The longest part between hits, from its largest reading on; its last two samples may be of the next hit.
std::pair<Index, Index> longest_decay(const VectorXd& signal, const std::vector<Index>& hits) {
  constexpr Index guard = 2;
  std::pair<Index, Index> longest{0, 0};
  for (std::size_t h = 0; h < hits.size(); ++h) {
    const Index end = h + 1 < hits.size() ? std::max(hits[h] + 1, hits[h + 1] - guard) : signal.size();
    Index largest = 0;
    signal.segment(hits[h], end - hits[h]).cwiseAbs().maxCoeff(&largest);
    if (end - hits[h] - largest > longest.second - longest.first) longest = {hits[h] + largest, end};
  }
  return longest;
}

/// The first sample behind the pulses of a measured force that stand in the first half of a part.
Index behind_pulses(const Record& record, const Record& measured, Index from, Index to) {
  constexpr double smallest = 0.02, noise = 8.0, most = 0.05;  // of the largest; deviations; of the samples
  double last = record.time[from] - record.interval();
  for (Index input = 0; input < measured.samples.rows(); ++input) {
    if (measured.channels[static_cast<std::size_t>(input)].quantity != Quantity::force) continue;
    const VectorXd force = measured.samples.row(input).transpose();
    if (!force.allFinite()) continue;
    const VectorXd size = distance_from_median(force);
    const double limit = std::max(smallest * size.maxCoeff(), noise * median(size));
    const auto above = (size.array() > limit).eval();
    if (static_cast<double>(above.count()) > most * static_cast<double>(size.size())) continue;  // no hammer
    for (Index k = 0; k < size.size() && measured.time[k] < record.time[(from + to) / 2]; ++k)
      if (above[k]) last = std::max(last, measured.time[k]);
  }
  while (from + fewest_decay_samples < to && record.time[from] <= last) ++from;
  return from;
}

/// The first sample of a free motion where a deflection is held from `from` on, and then released; else
/// `from`. Held: the signal stays beyond 0.3 of its deviation, from the mean of its last quarter, for more
/// than half a period of what follows, and beyond 0.75 of it for 0.7 of that time; a cosine is beyond 0.3
/// for a fifth of a period. The free motion begins where it falls below.
Index behind_hold(const VectorXd& signal, double interval, Index from, Index to) {
  constexpr double low = 0.3, high = 0.75, highest = 1.25;  // of the deviation
  constexpr double longest = 0.5, flat = 0.7;               // periods; of the samples beyond 0.3
  const Index count = to - from;
  if (count < 2 * fewest_decay_samples) return from;
  const double level = signal.segment(to - count / 4, count / 4).mean(), held = signal[from] - level;
  Index last = from, across = from;  // beyond 0.3, and on the other side
  for (; across < to && (signal[across] - level) / held > -low; ++across)
    if ((signal[across] - level) / held > low) last = across;
  if (to - across < fewest_decay_samples || last + 1 >= to) return from;
  const auto is_flat = [&](Index since) {
    const auto part = (signal.segment(since, last - since + 1).array() - level) / held;
    return static_cast<double>((part > high).count()) > flat * static_cast<double>(part.size());
  };
  Index since = from;  // the largest reading may be the last of what was held
  const auto beside = [&](Index k) { return (signal[k] - level) / held; };
  while (since > 0 && beside(since - 1) > low && beside(since - 1) < highest) --since;
  if (!is_flat(from) && !is_flat(since)) return from;
  try {
    const double period = 1.0 / strongest_frequency(signal.segment(across, to - across), interval);
    const auto is_long = [&](Index begin) {
      return static_cast<double>(last - begin + 1) * interval > longest * period;
    };
    return (is_flat(from) && is_long(from)) || (is_flat(since) && is_long(since)) ? last + 1 : from;
  } catch (const std::invalid_argument&) {
    return from;
  }
}

/// The channel and the sample of the largest reading, relative to each channel's own size.
std::pair<Index, Index> largest_reading(const Record& record) {
  const VectorXd size = record.samples.rowwise().norm().cwiseMax(1e-300);
  Index channel = 0, sample = 0;
  (size.cwiseInverse().asDiagonal() * record.samples).cwiseAbs().maxCoeff(&channel, &sample);
  return {channel, sample};
}

}  // namespace

bool has_hits(const Record& record) {
  const auto [channel, begin] = largest_reading(record);
  return !hits_of(record.samples.row(channel).array() - record.samples.row(channel).mean(), record.interval())
              .empty();
}

Record from_release(const Record& record, const Record& measured, std::vector<std::string>& remarks) {
  const auto [channel, begin] = largest_reading(record);
  const VectorXd signal = record.samples.row(channel).array() - record.samples.row(channel).mean();
  if (const std::vector<Index> hits = hits_of(signal, record.interval()); !hits.empty()) {
    auto [from, to] = longest_decay(signal, hits);
    from = behind_hold(signal, record.interval(), behind_pulses(record, measured, from, to), to);
    if (to - from >= fewest_decay_samples) {
      remarks.push_back(
          fmt::format("{} hits, the first at {} s: the longest decay between them is taken, {} to "
                      "{} s. Expected a --window for another.",
                      hits.size(), instant_text(record.time[hits.front()]), instant_text(record.time[from]),
                      instant_text(record.time[to - 1])));
      return part_of(record, from, to - from);
    }
  }
  const Index pulses_end = behind_pulses(record, measured, begin, record.size());
  const Index behind = behind_hold(signal, record.interval(), pulses_end, record.size());
  if (behind == 0 || record.size() - behind < fewest_decay_samples) return record;
  remarks.push_back(fmt::format("Window chosen automatically: the decay from {} on, {} s.",
                                behind > pulses_end  ? "the release of what was held"
                                : pulses_end > begin ? "the end of the force's pulse"
                                                     : "the largest reading",
                                instant_text(record.time[behind])));
  return part_of(record, behind, record.size() - behind);
}

void check_intervals(const Record& record) {
  const Index steps = record.size() - 1;
  const VectorXd step = record.time.tail(steps) - record.time.head(steps);
  const double interval = record.interval();
  Index at = 0;
  const double worst = (step.array() - interval).abs().maxCoeff(&at);
  if (worst <= 0.2 * interval + 2 * record.time_resolution) return;
  throw std::invalid_argument(
      fmt::format("an interval of {:.6g} s after {:.6g} s; modal analysis expects equal intervals, {:.6g} s "
                  "within 20 % (a --window without the gap, or the record resampled)",
                  step[at], record.time[at], interval));
}

}  // namespace beamid::experiments
