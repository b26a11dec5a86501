// The instants of LabVIEW segments that have no X columns.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "experiments/record/files/lvm/lvm_lines.hpp"
#include "experiments/record/record_table.hpp"

namespace beamid::experiments {

/// t_k = X0 + k Delta_X, each segment by its own header.
class LvmInstants {
 public:
  /// Those of a segment's rows. @param seconds of one unit of X; absent: the header tells no instants.
  /// @throws InputError at the header where its channels differ or it begins before the segment before ends.
  void add(const LvmSegment& segment, std::size_t rows, std::optional<double> seconds);

  const std::vector<double>& times() const {
    return times_;
  }  ///< [s]; of segments that tell none: no entries

  /// One clock for all of them; nothing where they do not follow each other at one interval.
  std::optional<Clock> clock() const;

 private:
  std::vector<double> times_;
  std::optional<Clock> first_;
  bool one_interval_ = true;
};

}  // namespace beamid::experiments
