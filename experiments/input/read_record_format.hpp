// The table [record] of an experiment file.
#pragma once

#include "experiments/experiment.hpp"
#include "experiments/input/toml_table.hpp"

namespace beamid::experiments {

/// How the record's file is to be read; its name is another key. Units are stated, never guessed.
/// @throws InputError at the key, for missing ones at the table.
RecordFormat read_record_format(const TomlTable& table, const fem::Beam& beam);

}  // namespace beamid::experiments
