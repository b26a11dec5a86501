// A record read and prepared: what the commands work on.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/record.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

// Samples that no sensor gives, left out of a record before anything is made of them.

/// What is wrong with a record, in a sentence, and when [s].
struct RecordDefect {
  std::string name;  ///< of the objection: "clipped", "gaps"
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
std::vector<Objection> objections_of(const std::vector<RecordDefect>& defects, const Record& record);

/// @throws InputError when more than half of a channel's samples are missing.
void refuse_mostly_missing(const Record& record, const std::vector<RecordDefect>& defects,
                           const std::filesystem::path& file);

// A measured input that a part of the record lacks.

/// Cuts the record to the longest stretch in which every input is known, or takes inputs as 0 where they are
/// not. @returns what was done, in a sentence; empty: nothing had to be, or the readings are left missing,
/// which what needs them refuses.
/// @throws std::invalid_argument when no stretch holds 16 samples.
std::string take_known_inputs(Record& record, MissingInput how);

/// The steps in their order; each adds its sentence to the record's remarks.
/// @param within what is wanted of the record [s]
/// @throws InputError at the step that the record does not allow.
Record prepare(Record record, const std::vector<Choice>& steps,
               const std::optional<std::pair<double, double>>& within = {});

/// A record as its file holds it, and as the steps and the window leave it.
struct PreparedRecord {
  Record raw;     ///< whole, before any step; samples that no sensor gives are missing (mark_defects)
  Record record;  ///< behind the steps, in the window, with warnings of what is wrong in it
  std::vector<RecordDefect> defects = {};  ///< of the whole

  /// Takes what the window of `format`, where it has one, leaves of a record already prepared.
  /// @param file it came from, for messages
  /// @throws InputError at the window, or where more than half of a channel is missing in it.
  void take(Record prepared, const RecordFormat& format, const std::filesystem::path& file);
};

/// read_record() of the whole file, without what no sensor gives, then the steps of `format` in their order,
/// then its window.
/// @throws InputError as read_record() and mark_defects(), at the step, or at the window.
PreparedRecord read_and_prepare(const std::filesystem::path& file, const RecordFormat& format);

/// The same, where only the prepared record is of use.
Record prepared_record(const std::filesystem::path& file, const RecordFormat& format = {});

}  // namespace beamid::experiments
