// What tracking found, for a person and for programs.
#pragma once

#include <string>

#include "experiments/identify/tracking/tracking.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// From one plateau to the next.
struct PlateauChange {
  double from = 0, to = 0;                        ///< [s], between which it happened
  double stiffness = 0, stiffness_deviation = 0;  ///< K_after / K_before - 1
  /// Whether it is beyond 3 deviations: else the motion alone was disturbed.
  bool of_stiffness() const;
};
std::vector<PlateauChange> changes(const Tracking& found);

/// Tables `plateaus` and `changes`, history.csv, figure `tracking`, results.json keys.
/// @param channel that was tracked.
Results report(const TrackSettings& settings, const Record& record, const Channel& channel,
               const std::string& record_name, const Tracking& found);

}  // namespace beamid::experiments
