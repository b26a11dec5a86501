// A record read and prepared: what the commands work on.
#pragma once

#include <filesystem>

#include "experiments/experiment.hpp"

namespace beamid::experiments {

/// The steps in their order; each adds its sentence to the record's remarks.
/// @throws InputError at the step that the record does not allow.
Record prepare(Record record, const std::vector<Choice>& steps);

/// A record as its file holds it, and as the steps and the window leave it.
struct PreparedRecord {
  Record raw;     ///< whole, before any step
  Record record;  ///< behind the steps, in the window
};

/// read_record() of the whole file, then the steps of `format` in their order, then its window.
/// @throws InputError as read_record(), at the step, or at the window.
PreparedRecord read_and_prepare(const std::filesystem::path& file, const RecordFormat& format);

/// The window of `format`, where it has one, of a record already prepared.
/// @param file it came from, for messages
/// @throws InputError at the window.
Record cut(Record record, const RecordFormat& format, const std::filesystem::path& file);

/// The same, where only the prepared record is of use.
Record prepared_record(const std::filesystem::path& file, const RecordFormat& format = {});

}  // namespace beamid::experiments
