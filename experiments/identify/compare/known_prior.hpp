// What is known before any record, and what passes over one make of it.
#pragma once

#include "experiments/identify/compare/first_guess.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/gaussian.hpp"

namespace beamid::experiments {

/// Of the unknowns alone, as the state carries them (q).
filters::Gaussian of_unknowns(const JointModel& model, const filters::Gaussian& estimate);

/// How far the unknown that moved most is from where it was linearised, `from` (n), in standard deviations.
double move_of(const JointModel& model, const Eigen::VectorXd& from, const filters::Gaussian& to);

/// A pass begins at another mean than what is known beforehand, and more certain of it (P_w, at m_w =
/// `start.mean`). What is known (P_0, at m_0) takes the place of that, once, in the unknowns U of the
/// estimate (P, m) behind it:
///
///     D = P_0^-1 - P_w^-1,   P' = P - P U D (I + U^T P U D)^-1 U^T P,
///     m' = m + P' U (P_0^-1 m_0 - P_w^-1 m_w - D U^T m)
///
/// A covariance kept as a factor has P_w = P_0, and its mean alone moves.
/// @param known_mean m_0 (q)
void take_known_prior(const JointModel& model, const filters::Gaussian& start, const FirstGuess& known,
                      const Eigen::VectorXd& known_mean, filters::Gaussian& last);

}  // namespace beamid::experiments
