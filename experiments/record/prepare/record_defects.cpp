#include "experiments/record/prepare/record_defects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "experiments/record/inspect/defects.hpp"
#include "experiments/record/inspect/noise_floor.hpp"
#include "experiments/signal/median.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

std::string record_defects_title(const Channel& channel) {
  const std::string quantity = to_string(channel.quantity);
  return channel.name.empty() || channel.name == quantity ? quantity
                                                          : fmt::format("{} ({})", channel.name, quantity);
}

/// One channel and what is found in it.
struct ChannelDefects {
  Record* record;
  Index row;
  std::vector<RecordDefect>* all;

  const Channel& channel() const { return record->channels[static_cast<std::size_t>(row)]; }
  std::string unit() const { return si_unit(channel().quantity); }

  void add(const std::string& what, const std::vector<Run>& runs, const std::string& consequence,
           bool clipped = false) const {
    if (runs.empty()) return;
    const auto time = [&](std::size_t sample) { return record->time[static_cast<Index>(sample)]; };
    const std::size_t samples = samples_in(runs);
    RecordDefect defect;
    defect.channel = row;
    defect.clipped = clipped;
    for (const Run& run : runs) defect.spans.emplace_back(time(run.first), time(run.first + run.length - 1));
    defect.text = fmt::format("{}: {}, {} of {} samples ({:.2g} %), {} {:.6g} s{}",
                              record_defects_title(channel()), what, samples, record->size(),
                              100 * static_cast<double>(samples) / static_cast<double>(record->size()),
                              samples > 1 ? "from" : "at", defect.spans.front().first,
                              samples > 1 ? fmt::format(" to {:.6g} s", defect.spans.back().second) : "") +
                  consequence;
    all->push_back(std::move(defect));
  }

  void leave_out(const std::vector<Run>& runs) const {
    for (const Run& run : runs)
      record->samples.row(row)
          .segment(static_cast<Index>(run.first), static_cast<Index>(run.length))
          .setConstant(std::numeric_limits<double>::quiet_NaN());
  }

  std::string levels(const std::vector<Run>& clipped) const {
    std::set<double> values;
    for (const Run& run : clipped) values.insert(run.value);
    std::string text;
    for (const double value : values) text += fmt::format("{}{:.4g}", text.empty() ? "" : " and ", value);
    return text + " " + unit();
  }
};

/// Whether the noise is 2 % of a limit or more: from there on a decay of 60 % of clipped amplitude has a
/// damping ratio that is off by more than its interval.
bool noise_decides(const Eigen::VectorXd& signal, const std::vector<Run>& clipped) {
  constexpr double share = 0.02;
  constexpr Index fewest = 64;
  if (clipped.empty() || signal.size() < fewest || !signal.allFinite()) return false;
  const double middle = median(signal);
  double limit = std::numeric_limits<double>::infinity();
  for (const Run& run : clipped) limit = std::min(limit, std::abs(run.value - middle));
  return noise_floor(signal) > share * limit;
}

void mark_gaps(const Record& record, std::vector<RecordDefect>& all) {
  constexpr double wide = 2.5;  // median intervals, as the step resample takes them
  const Index count = record.size() - 1;
  const Eigen::VectorXd steps = record.time.tail(count) - record.time.head(count);
  const double usual = median(steps), longest = steps.maxCoeff();
  RecordDefect gaps;
  for (Index k = 0; k < count; ++k)
    if (steps[k] > wide * usual + 1.000001 * record.time_resolution)
      gaps.spans.emplace_back(record.time[k], record.time[k + 1]);
  if (gaps.spans.empty()) return;
  gaps.text = fmt::format(
      "{} gap{} between the stamps, up to {:.4g} s long, the first behind {:.6g} s: nothing is made up in "
      "between.",
      gaps.spans.size(), gaps.spans.size() == 1 ? "" : "s", longest, gaps.spans.front().first);
  all.push_back(std::move(gaps));
}

}  // namespace

std::vector<RecordDefect> mark_defects(Record& record, const std::filesystem::path& file) {
  std::vector<RecordDefect> all;
  if (record.size() < 2) return all;
  mark_gaps(record, all);
  constexpr const char* left_out = "; they are left out.";
  // Under a moving base broadband noise that comes and goes with the motion is the base's.
  const bool shaken = std::any_of(record.channels.begin(), record.channels.end(), [](const Channel& one) {
    return is_input(one.quantity) && one.quantity != Quantity::force;
  });
  for (Index row = 0; row < record.samples.rows(); ++row) {
    const ChannelDefects channel{&record, row, &all};
    const Eigen::VectorXd signal = record.samples.row(row).transpose();
    const bool input = is_input(channel.channel().quantity);  // which may rest, and jump
    const Defects found =
        find_defects({signal.begin(), signal.end()}, input ? SignalKind::force : SignalKind::motion);
    if (found.dead)
      throw InputError(
          {file.string()},
          fmt::format("{} is dead: {:.4g} to {:.4g} {} over {} samples{}; expected a channel that moves. "
                      "--column or [[record.channels]] names the others",
                      record_defects_title(channel.channel()), signal.minCoeff(), signal.maxCoeff(),
                      channel.unit(), signal.size(), found.spikes.empty() ? "" : " but for spikes"));
    if (input) {
      const bool force = channel.channel().quantity == Quantity::force;
      channel.add("clipped at " + channel.levels(found.clipped), found.clipped,
                  fmt::format(": the {} was larger, and what is computed from it is wrong by that.",
                              force ? "force" : "acceleration"));
      continue;
    }
    if (!found.spikes.empty())
      channel.add(fmt::format("spikes, the first {:.3g} {}", found.spikes.front().value, channel.unit()),
                  found.spikes, found.spikes.size() > 1 ? left_out : "; it is left out.");
    channel.add("clipped at " + channel.levels(found.clipped), found.clipped,
                noise_decides(signal, found.clipped)
                    ? "; they are left out, but noise decides which readings beside them are not: amplitudes "
                      "near the limit come out too small, and the damping ratio of a decay with them. A "
                      "--window behind them avoids that."
                    : left_out,
                true);
    channel.add(fmt::format("{} drop-out{}", found.dropped.size(), found.dropped.size() == 1 ? "" : "s"),
                found.dropped, left_out);
    channel.add("repeats of the reading before", found.repeated, left_out);
    if (const auto& rattle = found.rattle; rattle && !shaken)
      channel.add(
          fmt::format("rattle, broadband noise {:.3g} times that of the quiet rest, while the motion is "
                      "large",
                      rattle->ratio),
          {{rattle->first, rattle->last - rattle->first + 1, 0}},
          ": a loose contact, whose damping is none of the beam's. A --window behind it avoids that.");
    for (const auto* runs : {&found.spikes, &found.clipped, &found.dropped, &found.repeated})
      channel.leave_out(*runs);
  }
  return all;
}

std::vector<std::string> warnings_of(const std::vector<RecordDefect>& defects, const Record& record) {
  const double from = record.time[0], to = record.time[record.size() - 1];
  std::vector<std::string> warnings;
  for (const RecordDefect& defect : defects)
    if (std::any_of(defect.spans.begin(), defect.spans.end(),
                    [&](const auto& span) { return span.first <= to && span.second >= from; }))
      warnings.push_back(defect.text);
  return warnings;
}

void refuse_mostly_missing(const Record& record, const std::vector<RecordDefect>& defects,
                           const std::filesystem::path& file) {
  constexpr double most = 0.5;
  for (Index row = 0; row < record.samples.rows(); ++row) {
    const double share = 1 - static_cast<double>(record.samples.row(row).array().isFinite().count()) /
                                 static_cast<double>(record.size());
    if (!(share > most)) continue;
    std::string why;
    for (const RecordDefect& defect : defects)
      if (defect.channel == row) why += (why.empty() ? "" : " ") + defect.text;
    throw InputError(
        {file.string()},
        fmt::format("{}: {:.0f} % of the samples from {:.4g} to {:.4g} s are of no use; expected at "
                    "most half. {} A --window where it is sound, other channels (--column, "
                    "[[record.channels]]) or a sensor of larger range help",
                    record_defects_title(record.channels[static_cast<std::size_t>(row)]), 100 * share,
                    record.time[0], record.time[record.size() - 1], why));
  }
}

}  // namespace beamid::experiments
