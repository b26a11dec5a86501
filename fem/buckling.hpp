// The axial loads that a beam or a frame bears.
#pragma once

#include <optional>

#include "fem/beam.hpp"
#include "fem/frame.hpp"
#include "fem/space_frame.hpp"

namespace beamid::fem {

/// The smallest compression [N] at which the beam, whatever its own axial load, has lost its stiffness: the
/// least P > 0 with det(K - P G) = 0, G from the elements' own geometric stiffness (elements/element.hpp), on
/// a mesh of `elements`. Nothing where the beam can move without strain.
/// @throws std::invalid_argument when the beam is impossible
std::optional<double> buckling_load(const Beam& beam, int elements = 40);

/// By how much all axial loads of a frame's members may grow together before it has lost its stiffness,
/// likewise, by bending or in space by twisting. Nothing where it can move without strain, or no growth does
/// that, as under tension alone.
std::optional<double> buckling_factor(const Frame& frame, int elements_per_member = 4);
std::optional<double> buckling_factor(const SpaceFrame& frame, int elements_per_member = 4);

}  // namespace beamid::fem
