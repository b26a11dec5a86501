// The page of inputs between samples in the atlas.
#pragma once

#include "experiments/results/results.hpp"
#include "experiments/studies/atlas/input_hold.hpp"

namespace beamid::experiments {

/// Adds it: text, table `input_hold`, figure `input_hold_error`, input_hold_map.csv, key `input_hold` of
/// results.json.
void add_hold_page(const HoldPage& page, const Oscillator& mode, Results& results);

}  // namespace beamid::experiments
