// Two modes of a free decay where a search over orders shows one.
#pragma once

#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// Poles less than a line apart are one pole to a search over orders, and a line that is wider than its mode.
/// For each mode that is found a pair is tried in its place: the realisation of order 4 [juang1985] of the
/// record without the other modes, then least squares of all. The pair stays where
///
/// - it reduces the squares by more than chance does: chi-square of 2 + 2 p degrees of freedom at 1e-6, by
///   the density of its residual near it;
/// - one mode whose frequency and damping drift (drifting_mode.hpp), of as many numbers, has squares larger
///   by 25 times that density;
/// - its residual is as dense near it as farther away: a frequency that follows the amplitude is no pair.
///
/// @param fit of found's modes, before and after
void split_close_pairs(RecordModes& found, JointDecayFit& fit);

}  // namespace beamid::experiments
