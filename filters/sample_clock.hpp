// Intervals between stamps.
#pragma once

#include <Eigen/Core>

namespace beamid::filters {

/// Which intervals a model has to move by, from stamp to stamp.
///
/// Stamps of a regular record are rounded, when computed or when printed, and taken literally they would make
/// it irregular. So a stamp that lies within `resolution` (and rounding: 8 eps of the stamp, 1e-9 of the
/// interval) of the regular grid since the last irregular one is taken to lie on the grid, and any other as
/// it is.
class SampleClock {
 public:
  /// @throws std::invalid_argument when regular <= 0, or the resolution is not from 0 to below half of it [s]
  explicit SampleClock(double regular, double resolution = 0.0);

  void start(double time);  ///< [s] @throws std::invalid_argument when it is not finite
  /// Interval from the sample before to this one [s].
  /// @throws std::invalid_argument when the stamp is not finite or does not lie after the one before.
  double advance(double time);
  double time() const { return stamp_; }  ///< the last stamp [s]

 private:
  double instant() const { return anchor_ + static_cast<double>(count_) * regular_; }

  double regular_, resolution_;
  double anchor_ = 0.0, stamp_ = 0.0;  // where the grid starts; the last stamp
  Eigen::Index count_ = 0;             // intervals of the grid since then
};

}  // namespace beamid::filters
