// Signs that a terminal is spared and a page or picture has.
#pragma once

#include <string>
#include <string_view>

namespace beamid::experiments {

/// "+-" as "±", "chi^2" as "χ²", "10^-8" as "10⁻⁸", and the exponents of units ("m/s2", "N m2", "[m2]")
/// raised. A name such as "m2" stays: an exponent is raised only behind a number, "[", "/" or another unit.
std::string typeset(std::string_view text);

}  // namespace beamid::experiments
