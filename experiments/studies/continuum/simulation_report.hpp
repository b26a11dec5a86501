// What `beamid simulate` prints and writes.
#pragma once

#include <memory>

#include "experiments/results/results.hpp"
#include "experiments/rig/simulated_test.hpp"

namespace beamid::experiments {

/// The table sensors, record.csv, results.json, a figure of each sensor's history and spectrum, and the
/// motion of the whole beam for ParaView where frames were kept.
/// @param surface draw the real sections instead of a line.
Results report(const Experiment& experiment, const std::shared_ptr<const SimulatedTest>& test, bool surface);

}  // namespace beamid::experiments
