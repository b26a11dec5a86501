// The tables [[parameters]] of an experiment file.
#pragma once

#include <vector>

#include "experiments/config/channel_places.hpp"
#include "experiments/config/schema.hpp"
#include "experiments/models/unknown.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

// What is assumed before a record is seen: [prior] and [noise] of an experiment file.

// What `beamid identifiability` looks at: [identifiability].

const Schema<IdentifiabilitySettings>& identifiability_keys();

/// @param root of the file. @throws InputError at a value of the wrong type or out of range.
void read_prior(const TomlTable& root, Experiment& experiment);

/// What the record is asked about. Whether the model has such a parameter the model says when it is made.
/// @param root the file's root table; @param structure to which regions and factors must belong
/// @throws InputError for a missing, a useless or a bad value.
std::vector<ParameterChoice> read_parameters(const TomlTable& root, const fem::Structure& structure);

}  // namespace beamid::experiments
