// The axial load that a beam bears.
#pragma once

#include <optional>

#include "fem/beam.hpp"

namespace beamid::fem {

/// The smallest compression [N] at which the beam, whatever its own axial load, has lost its stiffness: the
/// least P > 0 with det(K - P G) = 0, G from the elements' own geometric stiffness (elements/element.hpp), on
/// a mesh of `elements`. Nothing where the beam can move without strain.
/// @throws std::invalid_argument when the beam is impossible
std::optional<double> buckling_load(const Beam& beam, int elements = 40);

}  // namespace beamid::fem
