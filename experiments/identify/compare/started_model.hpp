// A model and the first guess that its filters start from.
#pragma once

#include <optional>
#include <string>

#include "experiments/config/channel_places.hpp"
#include "experiments/identify/compare/first_guess.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {

struct StartedModel {
  JointModel model;
  FirstGuess guess;                    ///< what counts as known before the record is filtered
  Eigen::VectorXd linearised_at = {};  ///< state of the first pass's motion (n); empty: the guess
  bool by_output_error = false;        ///< all samples at once have said it, where a filter lost its way
};

/// K and C of one degree of freedom where the modal analysis has them, as a discretisation will see them
/// (discretisation_bias.hpp), instead of a guess; what [prior] states stays what is known of them. A filter
/// that starts within 1 % of K keeps the phase of the first periods, whatever the beam; from 30 % it follows
/// a wrong branch in one clean record of fifty.
///
/// The modal analysis saw the same record. Standard deviations are 30 of its own at least, so that this
/// counts a thousandth of the record twice: of K 1 % at least, of C the whole of it.
/// @returns nothing for other models, and where the analysis has no such mode
std::optional<StartedModel> started_from_mode(const JointModel& model, const Prior& prior,
                                              const ModalEstimate& modal, const std::string& scheme,
                                              double interval);

/// A model, and what a first fit to the record makes of its unknowns (first_guess.hpp).
///
/// More than 12 coordinates do not help a fit that takes the low modes only, and cost it much: the truncation
/// to 12 modes of the beam as described takes the place of such a model. The start of a mesh that nobody has
/// reduced lies in a few modes of the beam, and their damping is theirs: it is made with the modes of what
/// was found, while what is known of the unknowns stays.
/// @param made of `model` for `setting`
/// @param frequency_hz of the first mode, as the record shows it
/// @throws as the model's registry
StartedModel started_model(JointModel made, const Choice& model, const ModelSetting& setting,
                           const filters::Measurements& record, double frequency_hz);

/// What is known of the unknowns without the record, about where the first fit has them (q).
/// @param outputs (p x N), for the sizes of what the model guesses by itself
filters::Gaussian known_about_start(const StartedModel& started, const ModelSetting& setting,
                                    const Eigen::MatrixXd& outputs);

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
