// What `beamid sweep` prints and writes.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/results/results.hpp"
#include "experiments/sweep/statistics.hpp"

namespace beamid::experiments {

/// A table of statistics per unknown, a figure against the first key that is a number, cases.csv, cases.h5
/// and manifest.json. The same rows give the same files, whoever worked them out.
/// @param rows of all cases, sorted
Results report(const nlohmann::ordered_json& manifest, const SweepPlan& plan, std::vector<SweepRow> rows);

/// Of every unknown, relative to its truth: against the first grid key that is a number, the rms of the
/// errors beside the bound, and how often the interval held the truth; without such a key, the errors against
/// the first one drawn; else none.
std::vector<Figure> figures(const SweepPlan& plan, const std::vector<SweepRow>& rows,
                            const std::vector<PointStatistics>& statistics);

/// "damping.ratio = 0.01, ekf": what sets an entry apart from the others; without the key `but`.
std::string name_of(const SweepPlan& plan, const std::vector<PointStatistics>& all,
                    const PointStatistics& one, std::size_t but);

}  // namespace beamid::experiments
