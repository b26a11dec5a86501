// What holds a space frame and sits on it: [[space_frame.supports]], [[space_frame.bodies]],
// [[space_frame.springs]], [[space_frame.dashpots]].
#pragma once

#include "experiments/text/toml_table.hpp"
#include "fem/space_frame.hpp"

namespace beamid::experiments {

/// Into a frame whose joints are known. @param table [space_frame]
/// @throws InputError naming file, line and column, what was found and what was expected.
void read_space_attachments(const TomlTable& table, fem::SpaceFrame& frame);

}  // namespace beamid::experiments
