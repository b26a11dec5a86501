// What is done to a free decay before and after the search of its poles: its drift taken off, close modes
// parted, all modes fitted at once.
#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/modal/channel_fault.hpp"
#include "experiments/modal/close_pair.hpp"
#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/phase_walk.hpp"
#include "experiments/modal/steady_lines.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/modal/study/mode_objections.hpp"
#include "experiments/modal/study/record_kind.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

/// Lines of what is analysed, of channels of about the same size.
std::vector<RecordLine> lines_of(const Record& record) {
  return record_lines(scales_of(record).cwiseInverse().asDiagonal() * record.samples, record.interval());
}

}  // namespace

std::optional<double> take_decay(const Record& measured, bool windowed, Record& whole,
                                 std::vector<RecordLine>& lines, RecordModes& found) {
  constexpr double cycles = 2.0;  // four cycles in two resolutions each
  const auto drift_of = [&](const Record& record) -> std::optional<DriftFree> {
    lines = lines_of(record);
    const auto lowest = std::ranges::find_if(
        lines, [](const RecordLine& line) { return line.frequency_hz >= cycles * line.resolution_hz; });
    return lowest == lines.end() ? std::nullopt : without_drift(record, lowest->frequency_hz);
  };
  std::vector<std::string> remarks;
  Record part = windowed ? whole : from_release(whole, measured, remarks);
  check_intervals(part);
  std::optional<DriftFree> free = drift_of(part);
  if (!free && part.size() < whole.size()) {  // a drift larger than the motion hides the release
    const std::vector<RecordLine> kept = lines;
    std::optional<DriftFree> of_whole = drift_of(whole);
    if (of_whole) {
      std::vector<std::string> others;
      const double begin = from_release(of_whole->record, measured, others).time[0];
      const Index first = std::lower_bound(whole.time.begin(), whole.time.end(), begin) - whole.time.begin();
      free = without_drift(part_of(whole, first, whole.size() - first), 1.0 / of_whole->period);
      if (free) remarks = std::move(others);
    }
    lines = kept;
  }
  std::ranges::move(remarks, std::back_inserter(found.remarks));
  if (!free) {
    found.record = std::move(part);
    return {};
  }
  found.drift = fmt::format(
      "The signal drifts by {:.2g} % of its motion (root mean square): a mean over {:.3g} s was taken off, "
      "which does not change frequencies and damping ratios and takes {:.3g} s off each end.",
      100.0 * free->share, 2.0 * free->period, free->period);
  found.remarks.push_back(found.drift);
  found.record = std::move(free->record);
  whole = found.record;
  lines = lines_of(found.record);
  return free->period;
}

namespace {

// Two modes of a free decay where a search over orders shows one.

/// Mode m may be the two of the pair: its intervals grow by their distances, each by its share of the larger.
void object_to_one(const ClosePair& pair, RecordModes& found) {
  ModeEstimate& one = found.modes[pair.m];
  const PairSpread spread = pair.spread_about(one.pole.frequency_hz(), one.pole.damping_ratio());
  one.frequency_spread_hz = spread.frequency_hz;
  one.damping_ratio_spread = spread.damping_ratio;
  found.objections.emplace_back(
      pair.objection(),
      pair.sentence(one.pole.frequency_hz()) +
          (pair.is_indeterminate()
               ? " The damping ratio is not determined; intervals are widened. A longer record or more "
                 "channels may separate them."
               : " Intervals are widened; --amplitude shows the damping ratio against the amplitude."),
      pair.over_drift, clearly_two);
}

/// For each mode that is found a pair is tried in its place (close_pair.hpp); one that wins stays.
/// @param fit of found's modes, before and after
/// @return those of which neither won
std::vector<ClosePair> split_close_pairs(RecordModes& found, JointDecayFit& fit) {
  constexpr double worth = 0.02;  // of the strongest
  const double strongest = found.strongest().strength;
  const std::size_t modes = found.modes.size();  // a mode of a pair is not parted again
  std::vector<ClosePair> open;
  for (std::size_t m = 0; m < modes; ++m) {
    if (found.modes[m].strength < worth * strongest) continue;
    auto pair = close_pair(found.target, found.interval, fit, m);
    if (pair && pair->wins) {
      found.modes.push_back(found.modes[m]);
      fit = std::move(pair->fit);
      for (std::size_t k = 0; k < found.modes.size(); ++k) found.modes[k].pole = fitted_pole(fit, k);
    } else if (pair) {
      open.push_back(*std::move(pair));
    }
  }
  return open;
}

// Whether all channels of a free decay ring at the same frequencies.

/// Where they do not (joint_decay_fit.hpp), the deviations of the joint frequencies are widened by how far
/// the farthest of the mode's channels is, for any of them may be right, and a warning says by how much the
/// clocks differ.
/// @param fit of found's modes, in their order
void compare_clocks(const JointDecayFit& fit, RecordModes& found) {
  const auto scatter = clock_scatter(fit);
  if (!scatter) return;
  for (std::size_t m = 0; m < found.modes.size(); ++m) {
    double& deviation = found.modes[m].pole.frequency_deviation_hz;
    deviation =
        std::hypot(deviation, scatter->farthest[static_cast<Eigen::Index>(m)] / (2.0 * std::numbers::pi));
  }
  found.objections.emplace_back(
      "channel_clocks",
      scatter->sentence(found.record.channel_names()) +
          " A frequency cannot show which is right; its standard deviations are widened by how far "
          "its channels are from it.");
}

using Modes = std::vector<ModeEstimate>;

void reject(std::size_t m, const std::string& why, RecordModes& found) {
  found.stabilisation.rejected.push_back({found.modes[m].pole, found.modes[m].orders, why});
  found.modes.erase(found.modes.begin() + static_cast<std::ptrdiff_t>(m));
}

/// Of two poles that are one mode, the one that is stable at fewer orders.
bool reject_twin(const std::vector<Pole>& poles, RecordModes& found) {
  const double duration = found.interval * static_cast<double>(found.target.cols());
  for (std::size_t a = 0; a < poles.size(); ++a)
    for (std::size_t b = a + 1; b < poles.size(); ++b) {
      if (!indistinguishable(poles[a], poles[b], duration)) continue;
      const auto weight = [&](std::size_t m) {
        return std::pair(found.modes[m].orders.size(), found.modes[m].strength);
      };
      const std::size_t kept = weight(a) < weight(b) ? b : a, lost = kept == a ? b : a;
      reject(lost,
             fmt::format("one mode with {:.4g} Hz: they cannot be separated in this record",
                         poles[kept].frequency_hz()),
             found);
      return true;
    }
  return false;
}

/// Of two fitted poles that are one drifting mode, the weaker.
bool reject_drifting(const JointDecayFit& fit, RecordModes& found) {
  for (std::size_t a = 0; a < found.modes.size(); ++a)
    for (std::size_t b = a + 1; b < found.modes.size(); ++b) {
      if (!is_one_drifting_mode(fit, a, b, found.target, found.interval)) continue;
      const bool first = fit.shapes.col(static_cast<Eigen::Index>(a)).norm() <
                         fit.shapes.col(static_cast<Eigen::Index>(b)).norm();
      reject(first ? a : b,
             fmt::format("one mode with {:.4g} Hz, whose frequency or damping follows the amplitude",
                         fitted_pole(fit, first ? b : a).frequency_hz()),
             found);
      return true;
    }
  return false;
}

/// A pole that the least squares have taken far beyond the damping of those that are sought: it stands for an
/// offset or the pulse of a hit. @returns whether there was one
bool reject_runaway(const std::vector<Pole>& poles, const StabilisationSettings& settings,
                    RecordModes& found) {
  constexpr double far = 2.0;
  for (std::size_t m = 0; m < poles.size(); ++m) {
    if (!(poles[m].damping_ratio() > far * settings.largest_damping_ratio)) continue;
    reject(
        m,
        fmt::format("runs away in the least squares, to a damping ratio of {:.2g}", poles[m].damping_ratio()),
        found);
    return true;
  }
  return false;
}

/// Nothing where it does not converge: then the weakest mode is rejected.
std::optional<JointDecayFit> fit_or_reject(RecordModes& found) {
  std::vector<std::complex<double>> start;
  for (const ModeEstimate& mode : found.modes) start.push_back(mode.pole.rate);
  std::string why;
  try {
    return fit_decays_jointly(found.target, found.interval, start);
  } catch (const std::runtime_error&) {
    why = "least squares of all modes do not converge with it";
  } catch (const std::invalid_argument&) {
    why = "too few samples to fit it";
  }
  const auto weakest =
      std::min_element(found.modes.begin(), found.modes.end(),
                       [](const ModeEstimate& a, const ModeEstimate& b) { return a.strength < b.strength; });
  reject(static_cast<std::size_t>(weakest - found.modes.begin()), why, found);
  return std::nullopt;
}

std::vector<Pole> poles_of(const Modes& modes) {
  std::vector<Pole> poles;
  for (const ModeEstimate& mode : modes) poles.push_back(mode.pole);
  return poles;
}

std::vector<Pole> poles_of(const JointDecayFit& fit) {
  std::vector<Pole> poles;
  for (std::size_t m = 0; m < fit.rates.size(); ++m) poles.push_back(fitted_pole(fit, m));
  return poles;
}

bool strongest_is_uncertain(const JointDecayFit& fit, const StabilisationSettings& settings,
                            const RecordModes& found) {
  const auto m = static_cast<std::size_t>(&found.strongest() - found.modes.data());
  return !objection_to(found.modes[m].pole, fit, m, found, settings).empty();
}

/// Only the least certain goes: without it, others may stay.
bool reject_least_certain(const JointDecayFit& fit, const StabilisationSettings& settings,
                          RecordModes& found) {
  std::optional<std::size_t> worst;
  double largest = -1;
  std::string why;
  for (std::size_t m = 0; m < found.modes.size(); ++m) {
    const Pole pole = fitted_pole(fit, m);
    std::string objection = objection_to(found.modes[m].pole, fit, m, found, settings);
    const double uncertainty = pole.frequency_deviation_hz / pole.frequency_hz();
    if (objection.empty() || uncertainty <= largest) continue;
    worst = m, largest = uncertainty, why = std::move(objection);
  }
  if (worst) reject(*worst, why, found);
  return worst.has_value();
}

/// What was rejected for the company it was in, the strongest first, is tried once more with those that
/// stayed: all of them have to. @param last the fit of found's modes, before and after
void try_again(Modes lost, const StabilisationSettings& settings, RecordModes& found, JointDecayFit& last) {
  std::sort(lost.begin(), lost.end(),
            [](const ModeEstimate& a, const ModeEstimate& b) { return a.strength > b.strength; });
  for (const ModeEstimate& one : lost) {
    RecordModes tried = found;
    tried.modes.push_back(one);
    std::erase_if(tried.stabilisation.rejected, [&](const PoleCluster& cluster) {
      return cluster.pole.rate == one.pole.rate && cluster.orders == one.orders;
    });
    const std::size_t rejected = tried.stabilisation.rejected.size();
    if (reject_twin(poles_of(tried.modes), tried)) continue;
    auto fit = fit_or_reject(tried);
    if (!fit || reject_least_certain(*fit, settings, tried) || reject_twin(poles_of(*fit), tried) ||
        reject_drifting(*fit, tried) || tried.stabilisation.rejected.size() != rejected)
      continue;
    for (std::size_t m = 0; m < tried.modes.size(); ++m) tried.modes[m].pole = fitted_pole(*fit, m);
    found = std::move(tried);
    last = std::move(*fit);
  }
}

/// A walk of the phases widens the deviations of all modes.
void follow_phases(const JointDecayFit& fit, RecordModes& found) {
  const auto walk = phase_walk(fit, found.target, found.interval);
  if (!walk) return;
  for (std::size_t m = 0; m < fit.rates.size(); ++m) {
    Pole& pole = found.modes[m].pole;
    walk->deviation(fit.rates[m]).widen(pole.frequency_deviation_hz, pole.damping_ratio_deviation);
  }
  if (!walk->is_sure()) return;
  std::vector<double> beside_hz;
  for (const std::size_t m : walk->sidebands) beside_hz.push_back(found.modes[m].pole.frequency_hz());
  found.objections.emplace_back(
      "phase_wander",
      walk->sentence() + (beside_hz.empty() ? ""
                                            : " What is listed at " + frequencies_text(beside_hz) +
                                                  " has the shape of a stronger mode beside "
                                                  "it, as a sideband of the walk."));
}

}  // namespace

void polish(RecordModes& found, const StabilisationSettings& settings) {
  const bool any = !found.modes.empty();
  while (reject_twin(poles_of(found.modes), found)) {
  }
  const Modes all = found.modes;
  while (!found.modes.empty()) {
    auto fit = fit_or_reject(found);
    if (!fit) continue;
    bool split = false;
    std::vector<ClosePair> open;
    if (found.free_decay && strongest_is_uncertain(*fit, settings, found)) {
      const std::size_t before = found.modes.size();  // a pair fitted as one mode makes that uncertain
      open = split_close_pairs(found, *fit);
      split = found.modes.size() > before;
    }
    if (reject_least_certain(*fit, settings, found)) continue;
    const std::vector<Pole> poles = poles_of(*fit);
    if (reject_runaway(poles, settings, found)) continue;
    if (!split && (reject_twin(poles, found) || reject_drifting(*fit, found))) continue;
    Modes lost;
    for (const ModeEstimate& mode : all)
      if (std::none_of(found.modes.begin(), found.modes.end(),
                       [&](const ModeEstimate& one) { return one.pole.rate == mode.pole.rate; }))
        lost.push_back(mode);
    for (std::size_t m = 0; m < poles.size(); ++m) found.modes[m].pole = poles[m];
    try_again(lost, settings, found, *fit);
    if (found.free_decay) {
      if (!split) open = split_close_pairs(found, *fit);
      for (const ClosePair& one : open) object_to_one(one, found);
      compare_clocks(*fit, found);
      follow_phases(*fit, found);
    }
    std::sort(found.modes.begin(), found.modes.end(),
              [](const auto& a, const auto& b) { return a.pole.frequency_hz() < b.pole.frequency_hz(); });
    found.polished = true;
    return;
  }
  if (any)
    found.objections.emplace_back(
        "no_deviations",
        "No pole was confirmed by least squares; --no-polish lists them as the method finds them.");
}

}  // namespace beamid::experiments
