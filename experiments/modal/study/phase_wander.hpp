// Whether the modes of a free decay keep their phases along the record.
#pragma once

#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// Even stamps of a clock whose intervals scatter, and frequencies that change, let phases wander about those
/// of the fit. In sections of the record, the fitted rates held, each mode's own amplitude is A_s e^(i phi_s)
/// of the joint one's. Where the phi_s, a line through them taken out, are larger than noise makes them
/// (chi^2 over modes and sections beyond its 99 % point), a random walk of them,
///
///     E (phi_t - phi_s)^2 = q |t - s|,
///
/// adds q max(sigma / 2, 1.2 / T) to the variance of the angular frequency of a mode of damping rate sigma in
/// a record of length T (weighted by e^(-2 sigma t), or not at all), and (q / 4)^2 to that of its rate. A
/// clock's walk is in time: q / omega^2, from all modes together. Weak modes beside a strong one, of its
/// shape in several channels, are left out: they would be its sidebands. Beyond the 99.99 % point a warning
/// says how large it is.
/// @param fit of found's modes, in their order
void follow_phases(const JointDecayFit& fit, RecordModes& found);

}  // namespace beamid::experiments
