// A sweep from its plan, or from its shards, to its rows.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/results/results.hpp"
#include "experiments/sweep/manifest.hpp"
#include "experiments/sweep/rows.hpp"
#include "experiments/sweep/statistics.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

struct SweepSettings {
  Shard shard;
  int threads = 1;
  std::optional<std::filesystem::path> journal;  ///< folder for finished cases (manifest.hpp); absent: memory
  std::optional<std::filesystem::path> done;  ///< cases.csv of the same sweep, whose cases are not repeated
  bool resume = false;                        ///< the journal
  Processes* processes = nullptr;             ///< that share the work; absent: threads of this one
};

/// Every case of the shard, sorted: run now, or kept from before.
/// @throws InputError when the experiment as it stands cannot be read; as Journal.
/// @throws std::runtime_error with the first reason when no case of a whole sweep could be run.
std::vector<SweepRow> perform(const SweepSource& source, const SweepPlan& plan, const SweepSettings& settings,
                              const Progress& progress);

/// In a process that has been started to help: runs the cases of a job that perform() in the first one tells.
void help(Processes& processes);

/// The results of folders that hold the shards of one sweep: those of the sweep in one piece.
/// @throws InputError when a folder is none of that sweep, when cases are missing or there twice.
Results merge(const std::vector<std::filesystem::path>& folders);

// What `beamid sweep` prints and writes.

/// A table of statistics per unknown, a figure against the first key that is a number, cases.csv, cases.h5
/// and manifest.json. The same rows give the same files, whoever worked them out.
/// @param rows of all cases, sorted
/// @param command "beamid sweep RECORD --config FILE --truth FILE", as far as it does not state the plan: a
/// click on a point of the figure shows what repeats it
Results report(const nlohmann::ordered_json& manifest, const SweepPlan& plan, std::vector<SweepRow> rows,
               const std::string& command = "beamid sweep --config FILE");

/// Of every unknown, relative to its truth: against the first grid key that is a number, the rms of the
/// errors beside the bound, and how often the interval held the truth; without such a key, the errors against
/// the first one drawn; else none. A click on a point shows its runs and what repeats them.
std::vector<Figure> figures(const SweepPlan& plan, const std::vector<SweepRow>& rows,
                            const std::vector<PointStatistics>& statistics,
                            const std::string& command = "beamid sweep --config FILE");

/// "damping.ratio = 0.01, ekf": what sets an entry apart from the others; without the key `but`.
std::string name_of(const SweepPlan& plan, const std::vector<PointStatistics>& all,
                    const PointStatistics& one, std::size_t but);

}  // namespace beamid::experiments
