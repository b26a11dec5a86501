// A beam in full, as results.json holds it.
#pragma once

#include <nlohmann/json.hpp>

#include "fem/beam.hpp"

namespace beamid::experiments {

/// Every quantity of the beam, worked out: what the file gives as dimensions and densities stands here as E I
/// and mass per length. A quantity that varies along its segment is an array of its values at 0, 1/4, 1/2,
/// 3/4 and all of the segment, which determine it. What the beam does not have is left out.
nlohmann::ordered_json describe(const fem::Beam& beam, int elements);

/// One segment of it, or the member of a frame.
nlohmann::ordered_json describe(const fem::Segment& segment);

/// All of the mass that moves: beam, bodies, absorbers [kg].
double total_mass(const fem::Beam& beam);

}  // namespace beamid::experiments
