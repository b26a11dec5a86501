// The first guess of a nonlinear model.
#pragma once

#include "experiments/identify/compare/first_guess.hpp"

namespace beamid::experiments {

/// Unknowns and motion after the first 4096 samples have been fitted, K from the frequency of the record, the
/// phase from all phases of one cycle (reproduction.hpp), then all unknowns and the start together
/// over parts of the record that double in length. A record that is low-passed and decimated, as linear
/// models hear it first, would be another motion to a nonlinear one.
///
/// As there, what is found bounds what filters start from with 30 times its deviations.
/// @param frequency_hz of the first mode, as the record shows it
/// @returns the guesses themselves where no motion of the model is near the record. Unlike that of linear
/// models, the mean holds the motion too.
FirstGuess nonlinear_guess(const JointModel& model, const std::vector<Observation>& observations,
                           const filters::Measurements& record, double frequency_hz);

}  // namespace beamid::experiments
