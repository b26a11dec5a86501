// The modes of a free decay refined by nonlinear least squares.
#pragma once

#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// All modes together, in all channels (fit_decays_jointly). Of two poles that cannot be told apart the one
/// of fewer orders goes to the rejected ones before the fit; where the fit does not converge, the weakest
/// goes; the weaker of two that are one drifting mode (close_pair.hpp); and, one at a time, the least
/// certain of those with an objection (mode_objections.hpp), and the rest is fitted anew. What went is tried
/// once more with those that stayed, for a pole may have gone for the company that it was in. Poles that no
/// fit has confirmed are no modes: where none is left, none is listed.
void polish(RecordModes& found, const StabilisationSettings& settings);

}  // namespace beamid::experiments
