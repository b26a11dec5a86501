// How `beamid simulate` says what sensors and logger did to the readings.
#pragma once

#include <string>

#include "experiments/rig/simulated_test.hpp"

namespace beamid::experiments {

/// A sentence for the logger and one for every sensor with a defect; empty where all is as it should be.
std::string acquisition_text(const SimulatedTest& test);

}  // namespace beamid::experiments
