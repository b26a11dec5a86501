// Keys as a person reads them.
#pragma once

#include <string>

namespace beamid::experiments {

/// "damping.ratio" as "damping ratio [-]", "stiffness_n_per_m" as "stiffness [N/m]", "sensors[1].noise_m" as
/// "sensors[1] noise [m]".
std::string key_label(const std::string& key);

}  // namespace beamid::experiments
