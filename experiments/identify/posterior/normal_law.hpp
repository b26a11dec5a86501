// The standard normal distribution: both tails to full relative accuracy.
#pragma once

namespace beamid::experiments {

double below_normal(double u);         ///< Phi(u)
double normal_quantile(double share);  ///< u of Phi(u); infinite at 0 and 1
double normal_density(double u);       ///< Phi'(u)

}  // namespace beamid::experiments
