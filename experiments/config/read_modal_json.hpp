// The results.json of `beamid modal`, read as measured modes.
#pragma once

#include <filesystem>

#include "experiments/config/experiment.hpp"
#include "experiments/modal/modal_data.hpp"

namespace beamid::experiments {

/// As read_modal_data() says. @throws InputError when the file is none that `beamid modal` wrote, or its
/// channels are not the experiment's sensors.
ModalData read_modal_json(const std::filesystem::path& file, const Experiment& experiment);

}  // namespace beamid::experiments
