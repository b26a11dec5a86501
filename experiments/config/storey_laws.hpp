// What is said of storeys that follow laws, and by whom they are not taken.
#pragma once

#include <string>

#include "experiments/config/experiment.hpp"

namespace beamid::experiments {

/// "storey 1 bouc_wen, storey 3 duffing"; empty where all are linear.
std::string storey_laws_text(const std::vector<StoreySpring>& springs);

/// That modes and frequency responses are those of small motion; empty where all storeys are linear.
std::string small_motion_note(const Experiment& experiment);

/// @throws InputError at the first law, "update takes linear storeys only; ..."
void require_linear_storeys(const Experiment& experiment, const std::string& command);

/// @throws InputError where the model is not `beam`, which alone moves them
void require_model_of_storeys(const Experiment& experiment);

}  // namespace beamid::experiments
