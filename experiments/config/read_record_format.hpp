// The table [record] of an experiment file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "experiments/config/experiment.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

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
