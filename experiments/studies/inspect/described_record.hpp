// An experiment file of one record: what was stated of it and what its file states, written down.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/record/record_format.hpp"

namespace beamid::experiments {

/// The table [record] that makes every command read the file as read_record(file, format) does, and comments
/// on what a structure needs besides.
/// @param folder of the experiment file, from which the record's path is counted
/// @throws InputError as read_record() does: the one question that is left.
std::string described_record(const std::filesystem::path& file, const RecordFormat& format,
                             const std::filesystem::path& folder);

}  // namespace beamid::experiments
