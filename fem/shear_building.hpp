// Masses in a row on springs: a shear building, or a soil column.
#pragma once

#include <vector>

#include "fem/beam.hpp"

namespace beamid::fem {

/// Floors that move sideways and do not turn, each on the storey below it.
struct Storeys {
  std::vector<double> masses;       ///< of the floors, from the lowest up [kg]
  std::vector<double> stiffnesses;  ///< of the storey below each [N/m]
  std::vector<double> dashpots;     ///< likewise [N s/m]; empty: none
  std::vector<double> heights;      ///< likewise [m]; empty: 1 m each
};

/// As a clamped beam: a storey is a column between floors that are guided, k = 12 E I / h^3, which one
/// element has exactly, and almost without mass of its own (1e-15 of the floors'). Whatever is done with
/// beams is done with it: positions are heights above the base, those of floors alone.
/// @throws std::invalid_argument when the numbers of values differ, or one is impossible
Beam shear_building(const Storeys& storeys);

/// 12 E I / h^3 of a storey of such a beam [N/m].
double storey_stiffness(const Segment& storey);

/// A layer of soil, for a column of 1 m2.
struct SoilLayer {
  double thickness = 0.0;            ///< h [m]
  double density = 0.0;              ///< rho [kg/m3]
  double shear_wave_velocity = 0.0;  ///< v [m/s]
};

/// k = rho v^2 / h of each layer, its mass rho h half at its top and half below, all per square metre.
/// @param layers from the lowest up
Storeys soil_column(const std::vector<SoilLayer>& layers);

}  // namespace beamid::fem
