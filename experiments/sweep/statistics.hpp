// What the cases of one point of a sweep's grid have in common.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "experiments/sweep/rows.hpp"
#include "filters/monte_carlo.hpp"

namespace beamid::experiments {

/// One unknown, found in one way, at one point: over all samples and seeds. Errors are estimate - truth of
/// the runs that converged; NaN where the truth is not known.
struct PointStatistics {
  std::size_t point = 0;
  std::string reduction, filter, discretisation, parameter, unit;
  int converged = 0, diverged = 0;
  int unusable = 0;            ///< refused or failed: no run of the filter at all
  double mean = std::nan("");  ///< of the estimates [unit]
  double bias = std::nan("");  ///< mean error [unit]
  double rms = std::nan("");   ///< of the errors [unit]
  double bias_percent = std::nan(""), rms_percent = std::nan("");  ///< of error / truth
  double bias_percent_error = std::nan("");  ///< standard error of the former, s / sqrt(n), s from n - 1
  double bound_percent = std::nan("");       ///< rms of bound / truth
  double rms_over_bound = std::nan("");      ///< sqrt(mean((error / bound)^2)): 1 for an efficient filter
  filters::Proportion coverage;              ///< truth within the 95 % interval; runs 0: truth not known
  filters::Proportion divergence;            ///< of the runs that there were; Wilson's interval as above

  bool same_run(const SweepRow& row) const {
    return reduction == row.reduction && filter == row.filter && discretisation == row.discretisation;
  }
};

/// In the order of points, then of the first row of each. A point where nothing was found has one entry
/// without an unknown for every way, or one without a name where no case could be run.
/// @param rows sorted by case
std::vector<PointStatistics> statistics(const SweepPlan& plan, const std::vector<SweepRow>& rows);

/// Runs as a table of text, the first row its head: those without an estimate first, then by falling error.
/// @param unit of the estimates; @param most runs at most
std::vector<std::vector<std::string>> run_table(const SweepPlan& plan, std::vector<const SweepRow*> runs,
                                                const std::string& unit, std::size_t most);

}  // namespace beamid::experiments
