// A first guess that the whole record can be linearised about.
#pragma once

#include <memory>
#include <string>

#include "experiments/identify/compare/low_mode_fit.hpp"
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

}  // namespace beamid::experiments
