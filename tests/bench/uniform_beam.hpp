// The beams that are timed: uniform, L = EI = rho A = 1.
#pragma once

#include <numbers>
#include <stdexcept>
#include <string>

#include "fem/beam.hpp"

namespace beamid::bench {

struct UniformBeam {
  fem::Beam beam;
  double root = 0.0;  ///< b of the lowest mode that is not rigid, omega = b^2
};

inline UniformBeam uniform_beam(const std::string& supports) {
  UniformBeam result;
  result.beam.segments = {{1.0, {1.0, 1.0, 0.0, {}, {}, {}}}};
  if (supports == "clamped-free") {
    result.root = 1.8751040687119611664;
    result.beam.supports = {{0.0, true, true}};
  } else if (supports == "clamped-clamped") {
    result.root = 4.7300407448627040260;
    result.beam.supports = {{0.0, true, true}, {1.0, true, true}};
  } else if (supports == "pinned-pinned") {
    result.root = std::numbers::pi;
    result.beam.supports = {{0.0, true, false}, {1.0, true, false}};
  } else if (supports == "free-free") {
    result.root = 4.7300407448627040260;
  } else {
    throw std::invalid_argument("unknown supports '" + supports +
                                "'; known: clamped-clamped, clamped-free, free-free, pinned-pinned");
  }
  return result;
}

}  // namespace beamid::bench
