// What may be wrong in the description of a beam.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fem/beam.hpp"

namespace beamid::experiments {

/// One physical quantity and a change x of it; x = 0 is the beam as described. Several structures share x:
/// the same clamp, the same material, the same forgotten mass.
struct Candidate {
  std::string name;             ///< "bending_stiffness"
  std::string unit;             ///< of x: "%" is a relative change with x = 0.01 for 1 %; else SI
  std::string value_unit;       ///< of what value() gives
  double scale = 1;             ///< a change that counts
  double lower = 0, upper = 0;  ///< what is possible
  double plausible_lower = 0, plausible_upper = 0;  ///< what careful work may get wrong
  bool exchangeable = false;  ///< may be another one altogether: a weight, a length in the clamp
  std::function<fem::Beam(const fem::Beam&, double)> changed = {};
  std::function<double(const fem::Beam&, double)> value = {};  ///< of the quantity itself, at x
};

/// Those that all of these beams can have, in this order:
///
///     bending_stiffness               E I (1 + x)                    plausible up to 15 %
///     beam_mass                       of the segments, (1 + x)       5 %
///     free_length                     L + x, all places in proportion  5 % of L
///     tip_mass                        m + x [kg]                     20 % of m, at least 5 % of the beam's
///     tip_rotary_inertia              J + m x, x [m2] a radius of gyration squared   x <= (L / 10)^2
///     tip_offset                      centre of mass x beyond its place [m]          5 % of L
///     root_rotational_compliance      1 / k + x [rad/(N m)]          x <= 0.1 L / E I
///     root_translational_compliance   1 / k + x [m/N]                x <= 0.02 L^3 / (3 E I)
///
/// Compliances, since zero is the ideal clamp and frequencies are smooth there. Of several beams the
/// narrowest limits count. Tip quantities need a free tip, inertia and offset a mass there too.
/// @param beams at least one.
std::vector<Candidate> candidates_of(const std::vector<fem::Beam>& beams);

/// All names, in the same order.
const std::vector<std::string>& candidate_names();

}  // namespace beamid::experiments
