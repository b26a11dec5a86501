// The modes of a free decay refined by nonlinear least squares.
#pragma once

#include "experiments/modal_study/modal_study.hpp"

namespace beamid::experiments {

/// All modes together, in all channels (fit_decays_jointly); those that run away, by more than a resolution
/// and 5 % in frequency or to a negative damping ratio, or stay too uncertain, go to the rejected ones and
/// the rest is fitted anew. Where the fit does not converge the modes stay as they are, and a warning says
/// so.
void polish(RecordModes& found, const StabilisationSettings& settings);

}  // namespace beamid::experiments
