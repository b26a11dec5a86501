// The steel beam of the study: 1.10 m x 60 mm x 6 mm, 2.12e11 Pa, 3.055 kg.
#pragma once

namespace beamid::apps {

/// b^2 / (2 pi) sqrt(EI / (m L^4)) for a root b of a frequency equation.
double study_beam_frequency_hz(double root);

}  // namespace beamid::apps
