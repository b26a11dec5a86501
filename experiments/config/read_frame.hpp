// The table [frame] of an experiment file.
#pragma once

#include "experiments/text/toml_table.hpp"
#include "fem/frame.hpp"

namespace beamid::experiments {

struct FrameExperiment {
  fem::Frame frame;
  int elements_per_member = 20;
};

/// Reads and checks the table; docs/configuration.md lists the keys. Joints are numbered from 1 in the order
/// of the file. A member's axial stiffness is given, or E A where Young's modulus and the dimensions are.
/// @throws InputError naming file, line and column, what was found and what was expected.
FrameExperiment read_frame(const TomlTable& table);

}  // namespace beamid::experiments
