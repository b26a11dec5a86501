// The table [record] of an experiment file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "experiments/config/experiment.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// How the record's file is to be read; its name is another key. Units are stated, never guessed.
/// @throws InputError at the key, for missing ones at the table.
RecordFormat read_record_format(const TomlTable& table, const fem::Beam& beam);

struct RecordSection {
  std::optional<std::string> file;  ///< relative to the TOML file's folder
  RecordFormat format;
};

/// The table [record] of a file that need not describe anything else. Without a [beam] positions are not
/// checked against its length, and a strain gauge's distance from the axis has no default.
/// @throws InputError as above.
RecordSection read_record_section(const std::filesystem::path& file);

}  // namespace beamid::experiments
