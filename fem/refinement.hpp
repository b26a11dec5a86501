// The same beam on a finer mesh.
#pragma once

#include <vector>

#include "fem/assembly.hpp"

namespace beamid::fem {

/// The mesh with every element cut into so many of equal length. @throws std::invalid_argument when parts < 1
Mesh refined(const Mesh& mesh, int parts);

/// assemble() on refined(cut(beam, elements, ...), parts): finer by the same factor everywhere, which a cut
/// into parts * elements need not be.
StructuralSystem assemble_refined(const Beam& beam, int elements, int parts,
                                  const std::vector<Point>& points);

}  // namespace beamid::fem
