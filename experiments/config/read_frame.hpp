// The table [frame] of an experiment file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/config/frame_description.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// Keys that describe a member: its ends, and those of a segment but its length (read_segment.hpp).
const std::vector<std::string>& member_keys();

/// Reads and checks a file that describes a plane frame; docs/configuration.md lists the keys. Joints are
/// numbered from 1 in the order of the file. A member's axial stiffness is given, or E A where Young's
/// modulus and the dimensions are.
/// @throws InputError naming file, line and column, what was found and what was expected; also for a table
/// that a frame has no use for.
FrameExperiment read_frame(const std::filesystem::path& file);

/// The same of a file already parsed. @param root its root table.
FrameExperiment read_frame(const TomlTable& root);

}  // namespace beamid::experiments
