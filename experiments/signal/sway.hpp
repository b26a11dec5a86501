// What moves slowly beneath an oscillation, taken out.
#pragma once

#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {

/// The signal (M) less its mean under a Hann window of two periods, a period at each end left out: of e^(s t)
/// it leaves (1 - H(s)) e^(s t), so that frequency and damping stay what they are. 1 - H is 1 at the period's
/// own frequency f, 0.5 at f / 2, 0.04 at f / 8. The signal itself where it is shorter than the window.
DecimatedSignal without_sway(DecimatedSignal signal, double period);

/// The mean of a signal under a Hann window of two periods, a period at each end left out: what the former
/// takes out. Empty where it is shorter than the window.
Eigen::VectorXd sway(const DecimatedSignal& signal, double period);

}  // namespace beamid::experiments
