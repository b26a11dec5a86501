// The same modes in several records, as one.
#pragma once

#include <vector>

#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// A mean over records and two ideas of its deviation. NaN where there is none.
struct MergedValue {
  double mean = 0;         ///< weighted by inverse variance where all deviations are known
  double deviation = 0;    ///< formal: what the records' own deviations leave of it
  double scatter = 0;      ///< of the mean, from the spread between the records
  bool scattered = false;  ///< chi^2 of the spread above 95 % of what the deviations allow
};

struct MergedMode {
  std::vector<int> places;  ///< in each record's modes; -1: not there
  MergedValue frequency_hz, damping_ratio;

  int records() const;  ///< in how many it is
};

/// Modes are the same when their frequencies are within 5 % and their MAC is 0.8 at least; of several, the
/// nearest. A mode of one record only is kept as well.
std::vector<MergedMode> merge_modes(const std::vector<RecordModes>& records);

}  // namespace beamid::experiments
