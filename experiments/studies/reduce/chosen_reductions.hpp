// Which reductions are compared when nobody says, and how they are called.
#pragma once

#include <string>
#include <vector>

#include "experiments/config/channel_places.hpp"

namespace beamid::experiments {

/// Every registered reduction but `none`, each with about three coordinates: three modes, or three masters
/// evenly along the beam; Rayleigh's has one, with each shape that the supports allow. Their places are
/// empty.
std::vector<Choice> default_reductions(const fem::Structure& structure);

/// Short and all different: the name; where it is there more than once, with the options that are not at
/// their defaults, "modal_truncation 3"; where that does not tell them apart, with a number, "guyan #2".
std::vector<std::string> labels(const std::vector<Choice>& choices);

}  // namespace beamid::experiments
