#include "experiments/record/prepare/analysable_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "experiments/record/prepare/preparation_step.hpp"
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
  return made.record;
}

}  // namespace beamid::experiments
