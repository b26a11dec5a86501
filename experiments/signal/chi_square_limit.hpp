// What chi-square stays below.
#pragma once

namespace beamid::experiments {

/// 95 % point of chi-square. @param freedom above 0
double chi_square_limit(double freedom);

}  // namespace beamid::experiments
