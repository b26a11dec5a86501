// A span of a beam between measured sections.
#pragma once

#include "experiments/identify/engine/comparison.hpp"

namespace beamid::experiments {

/// The unknowns of a span by the lines of its record's spectrum (line_likelihood.hpp): a comparison of one
/// run. Contradicted where its sensors move otherwise than the sections make it, diverged where no maximum is
/// found.
/// @param experiment experiment_of_part(); @param record record_of_part(); @param highest_hz of its lines;
/// absent: as record_lines()
/// @throws std::invalid_argument where stamps are uneven, readings are missing or the noise of a sensor
/// inside is not stated.
Comparison identify_span(const Experiment& experiment, ComparedRecord record,
                         const std::optional<double>& highest_hz = {});

}  // namespace beamid::experiments
