// A first guess that the whole record can be linearised about.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/low_mode_fit.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/discrete_model.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments {

constexpr Eigen::Index longest_guess = 1024;  ///< samples at the full rate, which filters take up well

/// The constants of the state (unknowns, offsets) after the record has passed a low-pass, then
/// through wider and wider ones.
///
/// A parameter 10 % off turns the phase of a mode by whole cycles within a few of them, of a mode at 500 Hz
/// within two samples at 1 kHz; a filter that is linearised there follows a wrong branch. A linear filter on
/// all channels leaves frequencies and damping as they are. So the record is decimated to about eight samples
/// per period of the first mode (signal/decimation.hpp), and the motion in the modes below half that rate is
/// fitted to it (low_mode_fit.hpp); then again at three times that rate, and so on, and at last to the
/// beginning of the record itself.
///
/// What a level finds, with deviations 30 times as large, bounds what the next starts from: near enough for
/// its linearisation, while the record is counted twice in a thousandth of the information only.
///
/// Of many unknowns a low level may end in a minimum of its own. Where the inputs are measured and the last
/// level leaves more than 15 % of the record's beginning, that beginning is asked alone: a few periods of the
/// fastest mode under a known force, then twice as many.
///
/// Of a driven record without gaps all lines of its spectrum say it at once (driven_fit.hpp).
///
/// @param frequency_hz of the first mode, as the record shows it
/// @param may_use_lines not where a mesh, in which every error of a start makes fast modes move, is started
/// so
/// @returns the guesses and their own deviations where the record is too short for it, or no motion of the
/// model is near it.
FirstGuess first_guess(const JointModel& model, const std::vector<Observation>& observations,
                       const filters::Measurements& record, double frequency_hz, bool may_use_lines = true);

/// Of a guess (q x q) found within `prior`: 30 times the deviations found, and what was known before.
Eigen::MatrixXd guess_covariance(const Eigen::MatrixXd& prior, const Eigen::MatrixXd& found);

/// What the model says of itself, at rest: where no record is to be looked at.
/// @param outputs (p x N) whose size scales the motion
FirstGuess own_guess(const JointModel& model, const std::vector<Observation>& observations,
                     const Eigen::MatrixXd& outputs);

/// The start directions with the unknowns' covariance of a guess.
StartDirections with_guess(StartDirections directions, const JointModel& model, const FirstGuess& guess);

/// The model by its finest discretisation.
std::unique_ptr<filters::DiscreteModel> finest(const JointModel& model, double interval,
                                               const Eigen::MatrixXd& output_noise);

// A model and the first guess that its filters start from.

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
