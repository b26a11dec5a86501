// Whether all channels of a free decay ring at the same frequencies.
#pragma once

#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// Where they do not (clock_scatter.hpp), the deviations of the joint frequencies are widened by how far the
/// farthest of the mode's channels is, for any of them may be right, and a warning says by how much the
/// clocks differ.
/// @param fit of found's modes, in their order
void compare_clocks(const JointDecayFit& fit, RecordModes& found);

}  // namespace beamid::experiments
