// A record as an analysis takes it that knows even stamps and finite samples only.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// A record at even stamps, without gaps, and what was done for that.
struct AnalysableRecord {
  Record record;
  std::string remark = {};  ///< what was done, a sentence or more; empty: nothing
  double share = 1;         ///< of its samples that were read, not filled in
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> filled = {};  ///< which were not; empty: all were read
  double density = 1;  ///< of its stamps over that of the readings
};

/// Stamps at unequal intervals are brought to an even grid by the step `resample`. Of samples that are
/// missing (NaN), runs of up to 0.6 periods of the channel's strongest line are filled in
/// (missing_samples.hpp); longer ones are not bridged: what lies between two of them, or one and the record's
/// end, is kept, the longest such part, or that which has most of `within`.
/// @param within [s]
/// @throws std::invalid_argument when a channel has no finite sample, or as the step resample.
AnalysableRecord analysable(const Record& record,
                            const std::optional<std::pair<double, double>>& within = {});

/// The record itself where its stamps are even, missing samples and all; else analysable().
AnalysableRecord on_even_stamps(const Record& record);

/// Its record, the remark among the record's own.
Record made_analysable(const Record& record);

}  // namespace beamid::experiments
