// The table [frame] of an experiment file.
#pragma once

#include <filesystem>

#include "experiments/config/frame_description.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// Reads and checks a file that describes a plane frame; docs/configuration.md lists the keys. Joints are
/// numbered from 1 in the order of the file. A member's axial stiffness is given, or E A where Young's
/// modulus and the dimensions are.
/// @throws InputError naming file, line and column, what was found and what was expected.
FrameExperiment read_frame(const std::filesystem::path& file);

/// The same of a file already parsed. @param root its root table.
FrameExperiment read_frame(const TomlTable& root);

/// The same of the table itself.
FrameExperiment read_frame_table(const TomlTable& frame);

}  // namespace beamid::experiments
