#include "experiments/record/prepare/preparation_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

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
  const bool same_rows = record.samples.rows() == before.samples.rows();
  for (Index row = 0; row < record.samples.rows(); ++row)
    for (Index from = same_rows ? row : 0; from < (same_rows ? row + 1 : before.samples.rows()); ++from)
      leave_out_gaps(before, from, record, row);
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

}  // namespace beamid::experiments
