// A record read and prepared: what the commands work on.
#pragma once

#include <filesystem>

#include "experiments/record/prepare/record_defects.hpp"
#include "experiments/record/record_format.hpp"

namespace beamid::experiments {

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
