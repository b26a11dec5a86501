// Segments and masses, worked out.
#pragma once

#include <nlohmann/json.hpp>

#include "fem/beam.hpp"

namespace beamid::experiments {

/// A segment, or the member of a frame, worked out: what the file gives as dimensions and densities stands
/// here as E I and mass per length. A quantity that varies along it is an array of its values at 0, 1/4, 1/2,
/// 3/4 and all of the segment, which determine it.
nlohmann::ordered_json describe(const fem::Segment& segment);

/// All of the mass that moves: beam, bodies, absorbers [kg].
double total_mass(const fem::Beam& beam);

}  // namespace beamid::experiments
