// What is wrong, unusual and in order with a record, as text, tables, figures and JSON.
#pragma once

#include "experiments/record/inspect/inspection.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Tables, warnings in words, and a figure of every channel's history and spectrum.
Results report(const Inspection& found);

}  // namespace beamid::experiments
