// A virtual test as its own logger records it.
#pragma once

#include "experiments/rig/simulated_test.hpp"

namespace beamid::experiments {

/// simulate() with what the experiment's sensors and logger do to the readings ([acquisition], the defects in
/// [[sensors]]), the record taken as a measured one is: clipped, repeated and lost samples are missing (NaN),
/// a warning says which (mark_defects), stamps stay as uneven as they are. What was recorded before the
/// excitation is cut off: here it is known when that begins. Of perfect instruments, the record as simulated.
/// @param name of the test, for messages
/// @throws as simulate(); InputError when a channel is dead, or more than half of it is of no use.
SimulatedTest logged_test(const Experiment& experiment, const std::filesystem::path& folder,
                          const std::string& name, const Progress& progress);

}  // namespace beamid::experiments
