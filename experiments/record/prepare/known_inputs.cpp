#include "experiments/record/prepare/known_inputs.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <vector>

namespace beamid::experiments {
namespace {

using Eigen::Index;

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
    return "Inputs are taken as 0 where they were not recorded, as missing_input says: " + text + ".";
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
      "Every input is known from {:.6g} to {:.6g} s: {:.0f} % of the record{}. The rest is left out.",
      record.time[0], record.time[record.size() - 1],
      100.0 * static_cast<double>(longest.second) / static_cast<double>(samples),
      all.size() > 1 ? fmt::format(", the longest of {} such stretches", all.size()) : "");
}

}  // namespace beamid::experiments
