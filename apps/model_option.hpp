// --model, of the commands that ask about the beam itself unless told otherwise.
#pragma once

#include "apps/command.hpp"
#include "experiments/config/experiment.hpp"

namespace beamid::apps {

/// What the command line says replaces what the file says; where neither does, it is model `beam`. Its
/// options are completed.
/// @throws InputError at "--model" or the file's place.
void choose_model(const options::variables_map& values, experiments::Experiment& experiment);

}  // namespace beamid::apps
