#include "experiments/record/prepare/preparation_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "experiments/record/prepare/channel_step.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double most_periods = 0.6;

/// Of a channel's strongest line [samples]; 0 where it does not move.
double period_of(const VectorXd& signal) {
  const VectorXd whole = bridged_straight(signal);
  if (whole.size() < 16 || !(whole.maxCoeff() > whole.minCoeff())) return 0;
  return 1 / strongest_frequency(whole, 1.0);
}

/// Stretches [first, last] without a gap too long to fill.
std::vector<std::pair<Index, Index>> stretches(const Record& record, const std::vector<double>& periods) {
  std::vector<bool> lost(static_cast<std::size_t>(record.size()), false);
  for (Index row = 0; row < record.samples.rows(); ++row)
    for (const auto& [first, count] : gaps_in(record.samples.row(row).transpose())) {
      const bool end = first == 0 || first + count == record.size();
      if (!end && static_cast<double>(count) <= std::max(1.0, most_periods * periods[row])) continue;
      std::fill_n(lost.begin() + first, count, true);
    }
  std::vector<std::pair<Index, Index>> found;
  for (Index k = 0; k < record.size(); ++k) {
    if (lost[k]) continue;
    if (found.empty() || found.back().second < k - 1) found.emplace_back(k, k);
    found.back().second = k;
  }
  return found;
}

/// Its length, or that of its part in the window [s].
double worth(const Record& record, const std::pair<Index, Index>& stretch,
             const std::optional<std::pair<double, double>>& within) {
  double from = record.time[stretch.first], to = record.time[stretch.second];
  if (within) from = std::max(from, within->first), to = std::min(to, within->second);
  return to - from;
}

}  // namespace

AnalysableRecord analysable(const Record& record, const std::optional<std::pair<double, double>>& within) {
  AnalysableRecord found{record};
  Record& left = found.record;
  if (!evenly_sampled(left)) {
    found.remark = "The stamps are uneven. " +
                   step_registry().make("resample", step_registry().completed("resample", {}))->apply(left);
    const Index even = left.samples.row(0).array().isFinite().count(),
                read = record.samples.row(0).array().isFinite().count();
    found.density = static_cast<double>(even) / static_cast<double>(std::max<Index>(read, 1));
  }
  if (left.samples.allFinite()) return found;
  std::vector<double> periods;
  for (Index row = 0; row < left.samples.rows(); ++row)
    periods.push_back(period_of(left.samples.row(row).transpose()));
  const auto parts = stretches(left, periods);
  if (parts.empty())
    throw std::invalid_argument("no instant at which every channel was read; expected a stretch of samples");
  const auto& [first, last] = *std::max_element(
      parts.begin(), parts.end(),
      [&](const auto& a, const auto& b) { return worth(left, a, within) < worth(left, b, within); });
  if (parts.size() > 1)
    found.remark +=
        fmt::format("{}Of {} parts between gaps that from {:.4g} to {:.4g} s is taken.",
                    found.remark.empty() ? "" : " ", parts.size(), left.time[first], left.time[last]);
  left.time = left.time.segment(first, last - first + 1).eval();
  left.samples = left.samples.middleCols(first, last - first + 1).eval();
  found.filled = !left.samples.array().isFinite();
  Index missing = 0;
  for (Index row = 0; row < left.samples.rows(); ++row) {
    const VectorXd signal = left.samples.row(row).transpose();
    missing += signal.size() - signal.array().isFinite().count();
    if (!signal.allFinite()) left.samples.row(row) = filled(signal, periods[row]).transpose();
  }
  found.share = 1 - static_cast<double>(missing) / static_cast<double>(left.samples.size());
  if (missing > 0)
    found.remark += fmt::format("{}{} missing sample{} filled in by local fits to what lies around.",
                                found.remark.empty() ? "" : " ", missing, missing == 1 ? " was" : "s were");
  return found;
}

AnalysableRecord on_even_stamps(const Record& record) {
  return evenly_sampled(record) ? AnalysableRecord{record} : analysable(record);
}

Record made_analysable(const Record& record) {
  AnalysableRecord made = analysable(record);
  if (!made.remark.empty()) made.record.remarks.push_back(made.remark);
  return std::move(made.record);
}

namespace {

/// The first sample that does not come one mean interval after the one before.
std::optional<Index> first_uneven(const Record& record) {
  constexpr double tolerated = 0.05;
  const double mean = record.interval();
  for (Index k = 1; k < record.size(); ++k)
    if (const double interval = record.time[k] - record.time[k - 1];
        !(std::abs(interval - mean) <= tolerated * mean + 1.000001 * record.time_resolution))
      return k;
  return std::nullopt;
}

/// Samples of a row that lie, by their stamps, in gaps of a row before.
void leave_out_gaps(const Record& before, Index from, Record& record, Index row) {
  const double slack = 0.5 * before.interval();
  for (const auto& [first, count] : gaps_in(before.samples.row(from).transpose())) {
    const double begin = before.time[first] - slack, end = before.time[first + count - 1] + slack;
    const double* const times = record.time.data();
    const Index left_out = std::lower_bound(times, times + record.size(), begin) - times,
                kept = std::upper_bound(times, times + record.size(), end) - times;
    record.samples.row(row)
        .segment(left_out, kept - left_out)
        .setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace

StepRegistry& step_registry() {
  static StepRegistry registry("preparation step");
  return registry;
}

std::string apply(const PreparationStep& step, Record& record,
                  const std::optional<std::pair<double, double>>& within) {
  if (step.takes_any_record() || (evenly_sampled(record) && record.samples.allFinite()))
    return step.apply(record);
  const Record before = record;
  AnalysableRecord ready = analysable(record, within);
  record = std::move(ready.record);
  const std::string text = step.apply(record);
  // What a step adds behind the channels that it keeps may come from any of them.
  const Index rows = before.samples.rows();
  bool keeps = record.samples.rows() >= rows;
  for (std::size_t i = 0; i < before.channels.size() && keeps; ++i)
    keeps = record.samples.rows() == rows || record.channels[i].name == before.channels[i].name;
  for (Index row = 0; row < record.samples.rows(); ++row)
    for (Index from = 0; from < rows; ++from)
      if (!keeps || row >= rows || from == row) leave_out_gaps(before, from, record, row);
  return ready.remark.empty() ? text : ready.remark + " " + text;
}

bool evenly_sampled(const Record& record) {
  return !first_uneven(record);
}

double even_interval(const Record& record) {
  if (const auto k = first_uneven(record))
    throw std::invalid_argument(
        fmt::format("an interval of {:.6g} s at {:.6g} s where the mean one is {:.6g} s; expected even "
                    "sampling, which a step = \"resample\" before this one makes",
                    record.time[*k] - record.time[*k - 1], record.time[*k], record.interval()));
  return record.interval();
}

int whole_option(const filters::Options& options, const std::string& name, int least, int most) {
  const double value = options.number(name);
  if (!(value >= least && value <= most && value == std::floor(value)))
    throw std::invalid_argument(
        fmt::format("{} is {:g}; expected a whole number from {} to {}", name, value, least, most));
  return static_cast<int>(value);
}

std::string word_option(const filters::Options& options, const std::string& name,
                        const std::vector<std::string>& words) {
  const std::string& value = options.text(name);
  if (std::find(words.begin(), words.end(), value) == words.end())
    throw std::invalid_argument(fmt::format("{} is '{}'; expected {}", name, value, fmt::join(words, ", ")));
  return value;
}

namespace {

bool means(const std::string& name, const Channel& channel) {
  return name == channel.name || name == to_string(channel.quantity);
}

}  // namespace

ChannelStep::ChannelStep(const filters::Options& options) {
  std::istringstream words(options.text("channels"));
  for (std::string word; std::getline(words, word, ',');) {
    word.erase(0, word.find_first_not_of(' '));
    word.erase(word.find_last_not_of(' ') + 1);
    if (word.empty()) throw std::invalid_argument("an empty name in channels; expected names between commas");
    names_.push_back(word);
  }
}

filters::OptionSpec ChannelStep::channels_option() {
  return {"channels", std::string(), "",
          "names or quantities between commas, as in \"acceleration, force\"; empty: all that it suits"};
}

bool ChannelStep::acts_on(const Channel& channel) const {
  return suits(channel.quantity) &&
         (names_.empty() ||
          std::any_of(names_.begin(), names_.end(), [&](const auto& name) { return means(name, channel); }));
}

std::vector<Eigen::Index> ChannelStep::rows(const Record& record) const {
  std::string known;
  for (const Channel& channel : record.channels)
    known += (known.empty() ? "" : ", ") + std::string(to_string(channel.quantity)) +
             (channel.name.empty() ? "" : " '" + channel.name + "'");
  for (const std::string& name : names_)
    if (std::none_of(record.channels.begin(), record.channels.end(),
                     [&](const Channel& channel) { return means(name, channel); }))
      throw std::invalid_argument("no channel '" + name + "'; the record has: " + known);
  std::vector<Eigen::Index> chosen;
  for (std::size_t i = 0; i < record.channels.size(); ++i)
    if (acts_on(record.channels[i])) chosen.push_back(static_cast<Eigen::Index>(i));
  if (chosen.empty()) throw std::invalid_argument("no channel that it suits; the record has: " + known);
  return chosen;
}

std::string ChannelStep::words(const Record& record, const std::vector<Eigen::Index>& rows) {
  std::string text;
  for (const Eigen::Index row : rows)
    text += (text.empty() ? "" : ", ") + std::string(to_string(record.channels[row].quantity)) +
            (record.channels[row].name.empty() ? "" : " '" + record.channels[row].name + "'");
  return text;
}

void ChannelStep::follow(std::vector<FollowedChannel>& channels, std::complex<double> rate,
                         double interval) const {
  for (FollowedChannel& followed : channels)
    if (acts_on(followed.channel)) followed.factor *= factor(rate, interval);
}

FilterStep::FilterStep(const filters::Options& options)
    : ChannelStep(options),
      zero_phase_(options.flag("zero_phase")),
      trim_(options.flag("trim")),
      start_(word_option(options, "start", {"steady", "rest"}) == "rest" ? FilterStart::rest
                                                                         : FilterStart::steady) {}

std::vector<filters::OptionSpec> FilterStep::with_common_options(std::vector<filters::OptionSpec> own) {
  own.push_back({"zero_phase", false, "", "forwards and backwards: no phase shift, the square of the gain"});
  own.push_back({"start", std::string("steady"), "",
                 "causal: before the record lies its first sample (steady) or zero (rest)"});
  own.push_back({"trim", false, "", "cut off the ends, until transients are down to 1e-3"});
  own.push_back(channels_option());
  return own;
}

void FilterStep::need(const char* option, double value) {
  if (!(value > 0))
    throw std::invalid_argument(fmt::format("{} is {}; expected a corner above 0 Hz", option,
                                            value == 0 ? "missing" : fmt::format("{:g}", value)));
}

double FilterStep::settling(double interval) const {
  return static_cast<double>(settling_samples(filter(interval))) * interval;
}

Transient FilterStep::transient(double interval) const {
  if (trim_) return {};
  const double lasting = settling(interval);
  return {lasting, zero_phase_ ? lasting : 0};
}

std::complex<double> FilterStep::factor(std::complex<double> rate, double interval) const {
  return zero_phase_ ? zero_phase_response(filter(interval), rate) : response(filter(interval), rate);
}

std::string FilterStep::apply(Record& record) const {
  const double interval = even_interval(record);
  const CascadedFilter sections = filter(interval);
  const std::vector<Eigen::Index> chosen = rows(record);
  for (const Eigen::Index row : chosen) {
    const Eigen::VectorXd signal = record.samples.row(row).transpose();
    record.samples.row(row) =
        (zero_phase_ ? filter_forward_backward(sections, signal) : filter_causally(sections, signal, start_))
            .transpose();
  }
  const double lasting = settling(interval);
  const char* ends = zero_phase_ ? "at both ends" : "at the start";
  std::string text = fmt::format("{}, {}, of {}; its transients last {:.3g} s {}", name(),
                                 zero_phase_ ? "zero-phase" : "causal", words(record, chosen), lasting, ends);
  if (trim_) {
    const double last = record.time[record.size() - 1];
    record = record.window(record.time[0] + lasting, zero_phase_ ? last - lasting : last);
    text += ", which were cut off";
  }
  return text + ".";
}

}  // namespace beamid::experiments
