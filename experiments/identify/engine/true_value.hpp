// What a parameter is in truth, where the record was simulated.
#pragma once

#include <filesystem>
#include <optional>

#include "experiments/config/experiment.hpp"
#include "experiments/models/unknown.hpp"

namespace beamid::experiments {

/// The mass of one degree of freedom at the record's first output, as the reduction leaves it of the beam
/// simulated [kg]; 0 where it leaves more than one coordinate, or nothing moves there.
/// @param folder in which the file of a given shape is looked for.
/// @throws as model_setting() and the reduction
double true_mass(const Experiment& truth, const Record& record, const Choice& reduction,
                 const std::filesystem::path& folder);

/// Properties of the beam are those of the beam simulated; a region's bending stiffness is its mean there,
/// damage included. K and C of one degree of freedom are those of its exact first mode, M omega_1^2 and
/// 2 xi_1 omega_1 M, with its own mass: a model that assumes another mass is wrong by as much, while that of
/// a reduction, which the assumed beam would have too, is not counted. An unknown mass is the modal mass at
/// the first output.
/// @param mass M, by true_mass() [kg]
/// @returns nothing where the beam simulated has no such quantity.
std::optional<double> true_value(const Experiment& truth, double mass, const Unknown& unknown);

}  // namespace beamid::experiments
