// A damping law against sections of the decay that it was fitted to.
#pragma once

#include "experiments/identify/damping_law/damping_law.hpp"

namespace beamid::experiments {

struct DecaySections {
  std::vector<AmplitudePoint> sections;
  double last_amplitude = 0;  ///< at the end of the last one, behind which noise hides the damping [m]
};

/// Frequency and damping ratio of the first channel's mode in sections that share no sample, along the decay
/// (amplitude_dependence.hpp), amplitudes as displacement [m]. The noise of the mode's envelope is the same
/// in all of them: deviations are the median of deviation times amplitude, over the amplitude. A section's
/// own, from a few values, is uncertain, and larger where the damping changes within it. Empty where the
/// record is too short for any.
DecaySections decay_sections(const Record& record, const ModalEstimate& modal);

/// What a law leaves of sections: chi^2 = sum ((xi_i - xi(a_i)) / d_i)^2 + ((f_i - f(a_i)) / e_i)^2.
/// @param fitted numbers of the law that these sections had a part in
LawMisfit misfit_of(const FittedLaw& law, const std::vector<AmplitudePoint>& sections, Eigen::Index fitted);

/// Displacement that an acceleration, a velocity or a displacement of 1 has at a frequency [m].
double displacement_per_reading(Quantity quantity, double frequency_hz);

}  // namespace beamid::experiments
