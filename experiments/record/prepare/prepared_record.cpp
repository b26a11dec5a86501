#include "experiments/record/prepare/prepared_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/record/inspect/defects.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/choice.hpp"
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

  void add(const char* name, const std::string& what, const std::vector<Run>& runs,
           const std::string& consequence, bool clipped = false) const {
    if (runs.empty()) return;
    const auto time = [&](std::size_t sample) { return record->time[static_cast<Index>(sample)]; };
    const std::size_t samples = samples_in(runs);
    RecordDefect defect{name, {}, {}};
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
  gaps.name = "gaps";
  gaps.text = fmt::format(
      "{} gap{} between the stamps, up to {:.4g} s long, the first behind {:.6g} s: gaps are not "
      "interpolated.",
      gaps.spans.size(), gaps.spans.size() == 1 ? "" : "s", longest, gaps.spans.front().first);
  all.push_back(std::move(gaps));
}

}  // namespace

std::vector<RecordDefect> mark_defects(Record& record, const std::filesystem::path& file) {
  std::vector<RecordDefect> all;
  if (record.size() < 2) return all;
  mark_gaps(record, all);
  constexpr const char* left_out = "; they are omitted.";
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
      channel.add("clipped", "clipped at " + channel.levels(found.clipped), found.clipped,
                  fmt::format(": the {} was larger, and what is computed from it is wrong by that.",
                              force ? "force" : "acceleration"));
      continue;
    }
    if (!found.spikes.empty())
      channel.add("spikes",
                  fmt::format("spikes, the first {:.3g} {}", found.spikes.front().value, channel.unit()),
                  found.spikes, found.spikes.size() > 1 ? left_out : "; it is omitted.");
    channel.add("clipped", "clipped at " + channel.levels(found.clipped), found.clipped,
                noise_decides(signal, found.clipped)
                    ? "; they are omitted, but noise decides which readings beside them are not. Amplitudes "
                      "near the limit come out too small, and the damping ratio of a decay with them. A "
                      "--window behind them avoids that."
                    : left_out,
                true);
    channel.add("dropped",
                fmt::format("{} drop-out{}", found.dropped.size(), found.dropped.size() == 1 ? "" : "s"),
                found.dropped, left_out);
    channel.add("repeated", "repeats of the reading before", found.repeated, left_out);
    if (const auto& rattle = found.rattle; rattle && !shaken)
      channel.add(
          "rattle",
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

std::vector<Objection> objections_of(const std::vector<RecordDefect>& defects, const Record& record) {
  const double from = record.time[0], to = record.time[record.size() - 1];
  std::vector<Objection> objections;
  for (const RecordDefect& defect : defects)
    if (std::any_of(defect.spans.begin(), defect.spans.end(),
                    [&](const auto& span) { return span.first <= to && span.second >= from; }))
      objections.emplace_back(defect.name, defect.text);
  return objections;
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

namespace {

/// First sample and number.
using Stretch = std::pair<Index, Index>;

/// Of samples at which all of these rows are known.
std::vector<Stretch> known_stretches(const Record& record, const std::vector<Index>& rows) {
  std::vector<Stretch> all;
  for (Index k = 0; k < record.size(); ++k) {
    if (!record.samples(rows, k).allFinite()) continue;
    if (all.empty() || all.back().first + all.back().second != k) all.emplace_back(k, 0);
    ++all.back().second;
  }
  return all;
}

}  // namespace

std::string take_known_inputs(Record& record, MissingInput how) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < record.channels.size(); ++i)
    if (is_input(record.channels[i].quantity)) rows.push_back(static_cast<Index>(i));
  if (how == MissingInput::refuse || rows.empty() || record.samples(rows, Eigen::all).allFinite()) return {};
  if (how == MissingInput::zero) {
    std::string text;
    for (const Index row : rows) {
      auto samples = record.samples.row(row).array();
      const Index missing = record.size() - samples.isFinite().count();
      if (missing == 0) continue;
      samples = samples.isFinite().select(samples, 0.0);
      text += fmt::format("{}{} of {} samples of '{}'", text.empty() ? "" : ", ", missing, record.size(),
                          record.channels[static_cast<std::size_t>(row)].name);
    }
    return "Inputs are taken as 0 where they were not recorded, as missing_input states: " + text + ".";
  }
  constexpr Index fewest = 16;
  const std::vector<Stretch> all = known_stretches(record, rows);
  Stretch longest{0, 0};
  for (const Stretch& one : all)
    if (one.second > longest.second) longest = one;
  if (longest.second < fewest)
    throw std::invalid_argument(
        fmt::format("the longest stretch in which every input is known has {} samples; expected {} at least",
                    longest.second, fewest));
  const Index samples = record.size();
  record = record.window(record.time[longest.first], record.time[longest.first + longest.second - 1]);
  return fmt::format(
      "Every input is known from {:.6g} to {:.6g} s: {:.0f} % of the record{}. The rest is omitted.",
      record.time[0], record.time[record.size() - 1],
      100.0 * static_cast<double>(longest.second) / static_cast<double>(samples),
      all.size() > 1 ? fmt::format(", the longest of {} such stretches", all.size()) : "");
}

Record prepare(Record record, const std::vector<Choice>& steps,
               const std::optional<std::pair<double, double>>& within) {
  for (const Choice& choice : steps)
    at_place(choice.place, [&] {
      try {
        const auto step = step_registry().make(choice.name, choice.options);
        const std::string remark = apply(*step, record, within);
        record.remarks.push_back(remark);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("step '" + choice.name + "': " + error.what());
      }
    });
  return record;
}

void PreparedRecord::take(Record prepared, const RecordFormat& format, const std::filesystem::path& file) {
  record = std::move(prepared);
  if (format.window)
    record = at_place(format.window_place.file.empty() ? Place{file.string()} : format.window_place,
                      [&] { return record.window(format.window->first, format.window->second); });
  std::string stretch =
      at_place(Place{file.string()}, [&] { return take_known_inputs(record, format.missing_input); });
  record.objections = raw.objections;
  for (Objection& one : objections_of(defects, record)) record.objections.push_back(std::move(one));
  if (!stretch.empty()) record.objections.emplace_back("missing_input", std::move(stretch));
  refuse_mostly_missing(record, defects, file);
}

PreparedRecord read_and_prepare(const std::filesystem::path& file, const RecordFormat& format) {
  RecordFormat whole = format;
  whole.window.reset();
  PreparedRecord prepared{read_record(file, whole), {}};
  prepared.defects = mark_defects(prepared.raw, file);
  prepared.take(prepare(prepared.raw, format.preparation, format.window), format, file);
  return prepared;
}

Record prepared_record(const std::filesystem::path& file, const RecordFormat& format) {
  return read_and_prepare(file, format).record;
}

}  // namespace beamid::experiments
