// One segment of a beam, as [beam] or [[beam.segments]] describes it.
#pragma once

#include "experiments/config/schema.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/beam.hpp"

namespace beamid::experiments {

/// The keys of a segment: its length and those of its section.
const KeyTable& segment_keys();

/// Stiffness: E I as such, or E with the dimensions of a rectangle, E I = E width height^3 / 12, or of a
/// circle, E pi diameter^4 / 64. Mass: in total, per length, or as a density with the dimensions. Dimensions
/// may go linearly to others at the segment's end, and with them all that follows from them; a total mass is
/// then spread in proportion to the section's area.
///
/// Timoshenko: kappa G A as such, or from the shear modulus, G = E / (2 (1 + nu)) unless given, and Cowper's
/// shear factor [cowper1966] unless given. Rotary inertia: rho I as such, or rho A times the section's I / A.
///
/// @throws InputError for missing, contradicting and useless keys, and for a bad value, at its own place.
fem::Segment read_segment(const TomlTable& table);

/// The same where the length [m] follows from something else, such as the joints of a frame's member.
fem::Section read_section(const TomlTable& table, double length);

}  // namespace beamid::experiments
