// A model and the first guess that its filters start from.
#pragma once

#include "experiments/config/experiment.hpp"
#include "experiments/identify/compare/first_guess.hpp"
#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {

struct StartedModel {
  JointModel model;
  FirstGuess guess;
};

/// The model of a setting, and what a first hearing of the record makes of its unknowns (first_guess.hpp).
///
/// More than 12 coordinates do not help a hearing that takes the low modes only, and cost it much: the
/// truncation to 12 modes of the beam as believed hears in place of such a model. The start of a mesh that
/// nobody has reduced lies in a few modes of the beam, and their damping is theirs: it is made with the modes
/// of what was found, while what is believed of the unknowns stays.
/// @param frequency_hz of the first mode, as the record shows it
/// @throws as the model's registry
StartedModel started_model(const Choice& model, const ModelSetting& setting,
                           const filters::Measurements& record, double frequency_hz);

/// The model with its basis where a state's unknowns are, what is known beforehand as it was; the model
/// itself where its motion does not depend on a basis that the beam's properties turn, or none can be made
/// there.
///
/// Held in the shapes of another beam, a reduction's frequencies err to second order in the difference, its
/// modal damping to first order.
/// @param from made of `setting`, with the unknowns' guesses
/// @param state of that model (n)
JointModel on_basis_at(const Choice& model, const ModelSetting& setting, const JointModel& from,
                       const Eigen::VectorXd& state);

}  // namespace beamid::experiments
