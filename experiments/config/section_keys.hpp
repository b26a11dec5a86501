// The keys that describe a section and its material: of a beam of one segment, of a segment, of a frame's
// member.
#pragma once

#include <optional>

#include "experiments/config/schema.hpp"

namespace beamid::experiments {

/// What a file says of a section, in SI units; absent: not said.
struct GivenSection {
  std::optional<double> width, height, diameter, end_width, end_height, end_diameter;
  std::optional<double> youngs_modulus, bending_stiffness;
  std::optional<double> mass, mass_per_length, density;
  bool timoshenko = false;
  std::optional<double> poissons_ratio, shear_modulus, shear_factor, shear_stiffness;
  std::optional<bool> with_rotary_inertia;
  std::optional<double> rotary_inertia;
};

const Schema<GivenSection>& section_keys();

}  // namespace beamid::experiments
