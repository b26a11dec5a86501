// What holds a plane frame and sits on it: [[frame.supports]], [[frame.bodies]], [[frame.springs]],
// [[frame.dashpots]].
#pragma once

#include "experiments/text/toml_table.hpp"
#include "fem/frame.hpp"

namespace beamid::experiments {

/// Into a frame whose joints are known. @param table [frame]
/// @throws InputError naming file, line and column, what was found and what was expected.
void read_frame_attachments(const TomlTable& table, fem::Frame& frame);

}  // namespace beamid::experiments
