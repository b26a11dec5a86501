// Whether the frequency of a free decay changes at one instant by a few per cent: something came loose.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "experiments/modal/frequency_jump.hpp"

namespace beamid::experiments {

/// The clearest step of the frequency of a decay (N, finite), by 0.3 to 18 %, where there is one. A damped
/// sine is fitted to every eight periods of the signal, decimated to eight samples per cycle and freed of
/// what sways below the mode. Between two such windows, two periods apart, the frequency steps where the
/// difference D
///
/// - is eight of its deviations and 0.3 % of the frequency,
/// - is five times what the frequencies of neighbours, one to four periods further away, differ by: where a
///   frequency follows the amplitude, or two modes beat, it changes there, too,
/// - and both fits leave less than a quarter of what the mode and its companions, of constant frequencies
///   over the whole record, leave there: beats that the modal analysis has found are no step; nor do two
///   damped sines fitted to both windows and what lies between them: beats that it has not found.
std::optional<FrequencyJump> frequency_step(const Eigen::VectorXd& signal, double interval,
                                            const ModalEstimate& mode);

}  // namespace beamid::experiments
