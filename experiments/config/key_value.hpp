// The value of one key in a user's table.
#pragma once

#include "experiments/config/schema.hpp"

namespace beamid::experiments {

/// @param length of the beam; infinite where none is described, NaN where it is not known yet
/// @returns nothing where the table does not hold the key, or where it holds tables
/// @throws InputError at the value's place where it is not what Key::expected() says
KeyValue read_value(const TomlTable& table, const Key& key, double length);

}  // namespace beamid::experiments
