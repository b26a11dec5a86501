// The tables [[parameters]] of an experiment file.
#pragma once

#include <vector>

#include "experiments/models/parameter_choice.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

/// What the record is asked about. Whether the model has such a parameter the model says when it is made.
/// @param root the file's root table; @param structure to which regions and factors must belong
/// @throws InputError for a missing, a useless or a bad value.
std::vector<ParameterChoice> read_parameters(const TomlTable& root, const fem::Structure& structure);

}  // namespace beamid::experiments
