// Where something sits on a structure: a position along a beam, or the name of a place of any other.
#pragma once

#include <string>

#include "experiments/text/toml_table.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

/// What `at` says; empty for beams, where `position_m` says it.
/// @param needed `at` must be there, where places have names
/// @throws InputError at `at` beside a beam, at `position_m` beside anything else, at a name that is none of
/// the structure's places.
std::string read_place(const TomlTable& table, const fem::Structure& structure, bool needed,
                       const std::string& at = "at", const std::string& position = "position_m");

/// "one of the places ridge.x, ridge.y, eaves.x, ... (12 in all)"
std::string expected_place(const fem::Structure& structure);

}  // namespace beamid::experiments
