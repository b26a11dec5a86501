// Options that choose a registered method by name; completion knows the names.
#pragma once

#include "apps/values.hpp"
#include "experiments/config/experiment.hpp"

namespace beamid::apps {

/// NAME[:OPTION=VALUE,...]
Option filter_option(const std::string& help);
Option reduction_option(const std::string& help);
Option modal_method_option(const std::string& help);
/// NAME
Option discretisation_option(const std::string& help);
Option smoother_option(const std::string& help);
/// --model, of the commands that ask about the beam itself without it.
Option model_option();
/// --on-failure
Option on_failure_option();

/// What --model says replaces what the file says; where neither does, it is model `beam`. Its options are
/// completed.
/// @throws InputError at "--model" or the file's place.
void choose_model(const Values& values, experiments::Experiment& experiment);

/// What --on-failure says replaces what the file says.
void choose_failure_response(const Values& values, experiments::Experiment& experiment);

}  // namespace beamid::apps
