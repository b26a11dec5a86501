// What a reduction to one coordinate leaves.
#pragma once

#include "fem/structural_system.hpp"

namespace beamid::test {

/// M q'' + K q = f, y = reading q.
fem::StructuralSystem one_coordinate(double mass, double stiffness, double reading = 1.0);

}  // namespace beamid::test
