#include "experiments/sweep/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace beamid::experiments {
namespace {

bool answers(const auto& row) {
  return row.status == "converged" || row.status == "approximate";
}

using Rows = std::vector<const SweepRow*>;

double square(double x) {
  return x * x;
}

/// Mean of what is finite; NaN without any.
template <class Number>
double mean_over(const Rows& rows, Number number) {
  double sum = 0.0;
  int count = 0;
  for (const SweepRow* row : rows)
    if (const double value = number(*row); std::isfinite(value)) {
      sum += value;
      ++count;
    }
  return count > 0 ? sum / count : std::nan("");
}

/// @param found rows of this unknown, of the runs that converged
void fill(PointStatistics& one, const Rows& found) {
  const auto share = [](const SweepRow& row) { return 100.0 * row.error / std::abs(row.truth); };
  one.mean = mean_over(found, [](const SweepRow& row) { return row.estimate; });
  one.bias = mean_over(found, [](const SweepRow& row) { return row.error; });
  one.rms = std::sqrt(mean_over(found, [](const SweepRow& row) { return square(row.error); }));
  one.bias_percent = mean_over(found, share);
  one.rms_percent = std::sqrt(mean_over(found, [&](const SweepRow& row) { return square(share(row)); }));
  one.bound_percent =
      std::sqrt(mean_over(found, [](const SweepRow& row) { return square(100.0 * row.bound / row.truth); }));
  one.rms_over_bound =
      std::sqrt(mean_over(found, [](const SweepRow& row) { return square(row.error / row.bound); }));
  int known = 0, covered = 0;
  for (const SweepRow* row : found) {
    if (!std::isfinite(row->truth)) continue;
    ++known;
    covered += row->lower <= row->truth && row->truth <= row->upper;
  }
  if (known > 0) one.coverage = filters::proportion(covered, known);
  const double variance =
      mean_over(found, [&](const SweepRow& row) { return square(share(row) - one.bias_percent); });
  if (known > 1) one.bias_percent_error = std::sqrt(variance / (known - 1));
}

/// All rows of one point.
void add_point(std::size_t point, const Rows& rows, std::vector<PointStatistics>& all) {
  const std::size_t first = all.size();
  const auto own = [&] { return std::pair(all.begin() + static_cast<std::ptrdiff_t>(first), all.end()); };
  // A run that found nothing belongs to every unknown that others of its kind have found.
  const auto entry = [&](const SweepRow& row, const std::string& parameter) {
    PointStatistics one;
    one.point = point;
    one.reduction = row.reduction;
    one.filter = row.filter;
    one.discretisation = row.discretisation;
    one.parameter = parameter;
    all.push_back(one);
  };
  for (const SweepRow* row : rows) {
    const auto [begin, end] = own();
    if (!row->parameter.empty() && std::none_of(begin, end, [&](const PointStatistics& one) {
          return one.same_run(*row) && one.parameter == row->parameter;
        })) {
      entry(*row, row->parameter);
      all.back().unit = row->unit;
    }
  }
  for (const SweepRow* row : rows) {
    const auto [begin, end] = own();
    const bool failed = row->status == "failed";
    if (row->parameter.empty() &&
        std::none_of(begin, end, [&](const PointStatistics& one) { return failed || one.same_run(*row); }))
      entry(*row, "");
  }
  for (std::size_t i = first; i < all.size(); ++i) {
    PointStatistics& one = all[i];
    Rows found;
    for (const SweepRow* row : rows) {
      const bool failed = row->status == "failed";
      if (!failed && !one.same_run(*row)) continue;
      if (!row->parameter.empty() && row->parameter != one.parameter) continue;
      one.converged += answers(*row);
      one.diverged += row->status == "diverged";
      one.unusable += failed || row->status == "refused";
      if (answers(*row)) found.push_back(row);
    }
    fill(one, found);
    if (one.converged + one.diverged > 0)
      one.divergence = filters::proportion(one.diverged, one.converged + one.diverged);
  }
}

}  // namespace

std::vector<PointStatistics> statistics(const SweepPlan& plan, const std::vector<SweepRow>& rows) {
  std::vector<PointStatistics> all;
  for (std::size_t begin = 0, end; begin < rows.size(); begin = end) {
    const std::size_t point = plan.point_of(rows[begin].number);
    Rows here;
    for (end = begin; end < rows.size() && plan.point_of(rows[end].number) == point; ++end)
      here.push_back(&rows[end]);
    add_point(point, here, all);
  }
  return all;
}

std::vector<std::vector<std::string>> run_table(const SweepPlan& plan, std::vector<const SweepRow*> runs,
                                                const std::string& unit, std::size_t most) {
  const auto size = [](const SweepRow* row) {
    return std::isfinite(row->error) ? std::abs(row->error) : std::numeric_limits<double>::infinity();
  };
  std::stable_sort(runs.begin(), runs.end(),
                   [&](const SweepRow* a, const SweepRow* b) { return size(a) > size(b); });
  runs.resize(std::min(runs.size(), most));
  std::vector<std::vector<std::string>> table{{"case", "seed"}};
  for (const VariedKey& key : plan.varied)
    if (key.is_drawn()) table[0].push_back(key.key);
  for (const std::string& head :
       {std::string("status"), unit.empty() ? "estimate" : "estimate [" + unit + "]",
        std::string("95 % from"), std::string("to"), std::string("error [%]")})
    table[0].push_back(head);
  const auto text = [](double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "-"; };
  for (const SweepRow* row : runs) {
    std::vector<std::string>& cells =
        table.emplace_back(std::vector{std::to_string(row->number), std::to_string(row->seed)});
    for (std::size_t j = 0; j < plan.varied.size(); ++j)
      if (plan.varied[j].is_drawn()) cells.push_back(row->values[j]);
    const double percent = 100.0 * row->error / std::abs(row->truth);
    cells.insert(cells.end(), {row->status, text(row->estimate), text(row->lower), text(row->upper),
                               std::isfinite(percent) ? fmt::format("{:+.3g}", percent) : "-"});
  }
  return table;
}

}  // namespace beamid::experiments
