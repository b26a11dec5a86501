// What `beamid identifiability` looks at: [identifiability].
#pragma once

#include "experiments/config/identifiability_settings.hpp"
#include "experiments/config/schema.hpp"

namespace beamid::experiments {

const Schema<IdentifiabilitySettings>& identifiability_keys();

}  // namespace beamid::experiments
