// Cases that differ in their noise alone, identified by one pass of the filter.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "experiments/sweep/rows.hpp"

namespace beamid::experiments {

/// @throws std::invalid_argument when the first case cannot be identified once: another model than sdof,
/// several reductions, a record from a file.
void require_once(const SweepSource& source, const SweepPlan& plan);

/// The joint identification of the 2009 study [inverse2009], over and over: the record is simulated, the
/// noise of its seed added, and the filter runs over it once, from what is assumed of K and C
/// ([[parameters]], else the beam as described) at rest anywhere within the record's amplitude. No first
/// guess and no second pass, as compare() has them.
///
/// The motion without noise, the model and the bound are worked out once for all seeds of a sample. The bound
/// is that of the beam and of the sensors simulated, at its K and C. The extended filter with its own
/// options, moved exactly or by forward Euler, takes several records side by side (filters/batch.hpp), others
/// one after another; what comes out of a record depends on that record alone.
class Repeats {
 public:
  Repeats(const SweepSource& source, const SweepPlan& plan) : source_(source), plan_(plan) {}

  /// Rows of the cases, which belong to one sample, in their order. Any number of threads at once. Throws
  /// nothing but std::bad_alloc: trouble is a row.
  std::vector<SweepRow> run(const CaseBlock& block);

 private:
  struct Common;  ///< what the seeds of a sample share
  struct Entry;

  const SweepSource& source_;
  const SweepPlan& plan_;
  std::mutex mutex_;
  std::map<std::size_t, std::shared_ptr<Entry>> kept_;  ///< of the samples that were asked for last

  std::shared_ptr<Entry> entry_of(std::size_t sample);
  std::shared_ptr<const Common> common_of(std::size_t number) const;
  static std::vector<std::optional<double>> bounds(const Common& common);
};

}  // namespace beamid::experiments
