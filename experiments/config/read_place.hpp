// Where something sits on a structure: a position along a beam, or the name of a place of any other.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "experiments/config/channel_places.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

/// What `at` says; empty for beams, where `position_m` says it.
/// @param needed `at` must be there, where places have names
/// @throws InputError at `at` beside a beam, at `position_m` beside anything else, at a name that is none of
/// the structure's places.
std::string read_place(const TomlTable& table, const fem::Structure& structure, bool needed,
                       const std::string& at = "at", const std::string& position = "position_m");

/// "one of the places ridge.x, ridge.y, eaves.x, ... (12 in all)"
std::string expected_place(const fem::Structure& structure);

// The table [record] of an experiment file.

struct RecordSection {
  std::optional<std::string> file;  ///< relative to the TOML file's folder
  RecordFormat format;
};

/// Units are stated, never guessed.
/// @param structure on which the sensors sit; null where none is described: positions are then not checked
/// against its length, and a strain gauge's distance from the axis has no default.
/// @throws InputError at the key, for missing ones at the table.
RecordSection read_record_section(const TomlTable& record, const fem::Structure* structure);

/// The same of a file that need not describe anything else. @throws InputError as above.
RecordSection read_record_section(const std::filesystem::path& file);

}  // namespace beamid::experiments
