// A structure in a sentence, and worked out, as results.json holds it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "experiments/config/experiment.hpp"

namespace beamid::experiments {

/// What it is, its masses, what holds it, mesh. @param elements of a beam's mesh
std::string structure_text(const Experiment& experiment, Eigen::Index elements, Eigen::Index coordinates);

/// What the keys of the file come to: masses, mesh, and the stiffness and mass of segments or members; of
/// matrices their unknowns.
nlohmann::ordered_json describe(const fem::Structure& structure, int elements);

/// All of the mass that moves [kg]; of matrices r^T M r under a motion of the base, 0 where that is not
/// known.
double total_mass(const fem::Structure& structure);

/// " at 1.2 m", " at ridge.x"; empty where neither is known.
std::string at_place_text(const std::optional<double>& position, const std::string& place);

}  // namespace beamid::experiments
