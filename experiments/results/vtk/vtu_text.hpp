// What the library of module/ gives to the one that loads it.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/vtk/vtu_file.hpp"

namespace beamid::experiments {

/// `beamid_vtu_text`: the text of a VTU file; false where VTK cannot write it.
using VtuText = bool(const BeamGrid& grid, const std::vector<PointArray>& arrays, std::string& text);

}  // namespace beamid::experiments
