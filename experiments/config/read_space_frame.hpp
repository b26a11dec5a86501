// The table [space_frame] of an experiment file.
#pragma once

#include "experiments/text/toml_table.hpp"
#include "fem/space_frame.hpp"

namespace beamid::experiments {

struct SpaceFrameExperiment {
  fem::SpaceFrame frame;
  int elements_per_member = 8;
};

/// Reads and checks the table; docs/configuration.md lists the keys. Joints are numbered from 1 in the order
/// of the file, sections have names.
/// @throws InputError naming file, line and column, what was found and what was expected.
SpaceFrameExperiment read_space_frame(const TomlTable& table);

}  // namespace beamid::experiments
