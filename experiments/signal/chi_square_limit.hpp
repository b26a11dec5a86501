// What chi-square stays below.
#pragma once

namespace beamid::experiments {

/// 95 % point of chi-square, or another one. @param freedom above 0
double chi_square_limit(double freedom, double probability = 0.95);

}  // namespace beamid::experiments
