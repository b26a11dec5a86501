// Errors as the study reports them: in per cent of a reference oscillator.
#pragma once

#include "experiments/models/discretisation_bias.hpp"

namespace beamid::experiments::paper {

inline double stiffness_error(const Oscillator& found, const Oscillator& reference) {
  return percent(found.stiffness, reference.stiffness);
}

inline double damping_error(const Oscillator& found, const Oscillator& reference) {
  return percent(found.damping, reference.damping);
}

}  // namespace beamid::experiments::paper
