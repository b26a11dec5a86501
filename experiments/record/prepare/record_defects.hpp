// Samples that no sensor gives, left out of a record before anything is made of them.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// What is wrong with a record, in a sentence, and when [s].
struct RecordDefect {
  std::string text;
  std::vector<std::pair<double, double>> spans;
  Eigen::Index channel = -1;  ///< -1: of all
  bool clipped = false;       ///< readings of a motion at the end of the sensor's range
};

/// Finds the defects of every channel (find_defects), gaps between the stamps among them, and makes samples
/// of motion missing (NaN) that are clipped, dropped out, repeated or spikes.
/// @throws InputError when a channel of motion is dead.
std::vector<RecordDefect> mark_defects(Record& record, const std::filesystem::path& file);

/// Those sentences that concern what the record, cut to a window, still holds.
std::vector<std::string> warnings_of(const std::vector<RecordDefect>& defects, const Record& record);

/// @throws InputError when more than half of a channel's samples are missing.
void refuse_mostly_missing(const Record& record, const std::vector<RecordDefect>& defects,
                           const std::filesystem::path& file);

}  // namespace beamid::experiments
