// Estimates beside the prior that they started from.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/engine/compared_run.hpp"

namespace beamid::experiments {

/// Estimates beside what was described or given as a prior, p0 +- s0.
struct AgainstDescription {
  std::string scale;         ///< all masses and stiffnesses are wrong by one factor; empty: they are not
  bool contradicts = false;  ///< the priors exclude that factor
  std::vector<std::string>
      differences;  ///< parameters, each more than four s0 away; none where `scale` has it
};

/// The force, and nothing else, fixes the scale of what it weighs: with a force e times too large all masses,
/// stiffnesses and dashpots of M x'' + C x' + K x = f come out e times too large, the motion is met as well
/// as ever, and only what was known beforehand can tell. With r_j = log(p_j / p0_j) and s_j^2 = (s0_j /
/// p0_j)^2 + (s_j / p_j)^2 the factor is g = sum r_j / s_j^2 / sum 1 / s_j^2, with the deviation (sum 1 /
/// s_j^2)^-1/2. It is one factor where sum (r_j - g)^2 / s_j^2 is less than its chi-square's 99.9 % point.
/// The priors exclude it from four deviations on. From one and a half on it is still no coincidence where
/// all r_j lie together within a tenth of g.
///
/// A damping known to 100 % or less well states no prior, and is left out.
/// @param by_force whether a force was measured, which the scale then comes from
/// @param unknowns of the same parameters, in whose coordinates they are away from their priors; empty:
/// linear
AgainstDescription against_description(const std::vector<ComparedParameter>& parameters, bool by_force,
                                       const std::vector<Unknown>& unknowns = {});

/// ", as with 9.80665, a force in N taken for kgf ...": of a force's reading over the force, or a motion over
/// its reading, what makes such a factor within exp(+-near); empty: nothing usual.
std::string usual_scale(double factor, double near);

/// Puts it among the warnings of a run; its status becomes contradicted where the priors exclude the factor.
void judge_description(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
