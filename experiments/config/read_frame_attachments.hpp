// What holds a plane frame and sits on it: [[frame.supports]], [[frame.bodies]], [[frame.springs]],
// [[frame.dashpots]].
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "experiments/text/toml_table.hpp"
#include "fem/frame.hpp"

namespace beamid::experiments {

/// Into a frame whose joints are known. @param table [frame]
/// @throws InputError naming file, line and column, what was found and what was expected.
void read_frame_attachments(const TomlTable& table, fem::Frame& frame);

/// The same in the keys of a file; joints by their number, from 1.
void describe_frame_attachments(const fem::Frame& frame, nlohmann::ordered_json& json);

}  // namespace beamid::experiments
