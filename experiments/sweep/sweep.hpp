// The cases of a sweep on all cores.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <vector>

#include "experiments/sweep/rows.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// Cases that are run together, usually one.
using CaseBlock = std::vector<std::size_t>;

/// The blocks of the cases that are left: one by one, or, where the plan identifies once, up to 16 neighbours
/// that differ in their seeds alone. No result depends on it.
std::vector<CaseBlock> blocks_of(const SweepPlan& plan, const std::vector<std::size_t>& numbers);

/// Hands out the blocks that are left, one by one, to any thread.
class CaseQueue {
 public:
  explicit CaseQueue(std::vector<CaseBlock> blocks) : blocks_(std::move(blocks)) {}
  /// False when there is none any more. @param block the next one
  bool next(CaseBlock& block);
  void stop();  ///< hands out no more
  std::size_t blocks() const;
  std::size_t cases() const;  ///< of all blocks

 private:
  std::mutex mutex_;
  std::vector<CaseBlock> blocks_;
  std::size_t given_ = 0;
};

using CaseRunner = std::function<std::vector<SweepRow>(const CaseBlock& block)>;
using CaseSink = std::function<void(std::vector<SweepRow> rows)>;

/// Runs what the queue hands out on so many threads, or on fewer where there are not as many blocks or the
/// system does not allow them. The sink gets every block when it is finished, in
/// whatever order, from one thread at a time. The first exception of runner or sink stops the rest and is
/// thrown when all threads have ended.
void run_cases(CaseQueue& queue, int threads, const CaseRunner& run, const CaseSink& sink);

/// Rows in the order of their cases.
void sort_rows(std::vector<SweepRow>& rows);

}  // namespace beamid::experiments
