// The sections of a space frame, [[space_frame.sections]], which members name.
#pragma once

#include <map>
#include <string>

#include "experiments/config/schema.hpp"
#include "fem/space_frame.hpp"

namespace beamid::experiments {

/// All sections by their names.
/// @param table [space_frame]
/// @throws InputError for missing, contradicting and useless keys, a bad value, and a name given twice.
std::map<std::string, fem::SpaceSection> read_space_sections(const TomlTable& table);

}  // namespace beamid::experiments
