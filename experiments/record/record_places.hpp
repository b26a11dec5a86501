// Where the channels of a record sit, as a TOML file beside it says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// The TOML file that belongs to a record: record.toml to record.csv, in the same folder.
std::filesystem::path places_file(const std::filesystem::path& record);

/// Positions and distances of the channels that have none, by the names of their columns, and how forces run
/// between samples, from places_file(); nothing where there is no such file, or its record.file names another
/// record.
/// @param columns of the channels, in their order; empty names match none
/// @throws InputError when the file is no valid TOML, or a value is impossible.
void take_places(const std::filesystem::path& file, const std::vector<std::string>& columns, Record& record);

/// The text of places_file(): `[record]` with a `[[record.channels]]` for every channel, SI units.
std::string places_text(const Record& record, const std::string& file_name);

}  // namespace beamid::experiments
