// What may be wrong in the description of a structure.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fem/structure.hpp"

namespace beamid::experiments {

inline constexpr const char* of_described = "of described";  ///< unit of values that are factors

/// One physical quantity and a change x of it; x = 0 is the structure as described. Several structures share
/// x: the same clamp, the same material, the same forgotten mass.
struct Candidate {
  std::string name;             ///< "bending_stiffness"
  std::string label;            ///< in sentences: "bending stiffness"
  std::string unit;             ///< of x: "%" is a relative change with x = 0.01 for 1 %; else SI
  std::string value_unit;       ///< of what value() gives
  double lower = 0, upper = 0;  ///< what is possible
  double plausible_lower = 0, plausible_upper = 0;  ///< what careful work may get wrong
  bool exchangeable = false;  ///< may be another one altogether: a weight, a length in the clamp
  bool weighs_all =
      false;              ///< a factor of all masses: only a measured force separates it from all stiffnesses
  bool of_clock = false;  ///< frequencies become (1 + x) times as high, the structure stays as it is
  std::function<fem::Structure(const fem::Structure&, double)> changed = {};
  std::function<double(const fem::Structure&, double)> value = {};  ///< of the quantity itself, at x

  /// A change that counts: half of what is plausible either way. What the modes leave open by more than
  /// half of it (update's open_deviation) they do not determine.
  double scale() const { return 0.5 * (plausible_upper - plausible_lower); }
};

/// Those that all of these structures can have. Of a beam, in this order:
///
///     bending_stiffness               E I (1 + x)                    plausible up to 15 %
///     beam_mass                       of the segments, (1 + x)       5 %
///     free_length                     L + x, all places in proportion  5 % of L
///     tip_mass                        m + x [kg]                     20 % of m, at least 5 % of the beam's
///     tip_rotary_inertia              J + m x, x [m2] a radius of gyration squared   x <= (L / 10)^2
///     tip_offset                      centre of mass x beyond its place [m]          5 % of L
///     root_rotational_compliance      1 / k + x [rad/(N m)]          x <= 0.1 L / E I
///     root_translational_compliance   1 / k + x [m/N]                x <= 0.02 L^3 / (3 E I)
///     record_clock                    the stated sampling rate over the true one, 1 + x   3 %
///
/// of other structures relative changes (1 + x), and the clock:
///
///     chain         storey_stiffness 15 %, storey_stiffness_1 ... 30 %, floor_mass 5 %, floor_mass_1 ... 20
///     % frames        youngs_modulus 15 %, each group's factor by its name 30 %, member_mass 5 %,
///                   body_mass_JOINT 20 %, spring_JOINT 30 %, axial_loads 30 %,
///                   support_compliance (of all) and support_compliance_JOINT: rotation, 0 to 0.1 of what the
///                   members there have, 1 / sum (E I / L)
///     system        stiffness 15 %, mass 5 %, each parameter by its name 30 %
///
/// Compliances, since zero is the ideal clamp and frequencies are smooth there. Of several structures the
/// narrowest limits count. Tip quantities need a free tip, inertia and offset a mass there too.
/// @param structures at least one.
std::vector<Candidate> candidates_of(const std::vector<fem::Structure>& structures);

/// Of one kind, without the clock. @throws std::invalid_argument as value_of()
std::vector<Candidate> beam_candidates(const fem::Beam& beam);
std::vector<Candidate> chain_candidates(const fem::Beam& chain);
std::vector<Candidate> frame_candidates(const fem::Structure& frame);
std::vector<Candidate> system_candidates(const fem::MatrixSystem& system);

/// A relative change, possible from -90 % to tenfold. @param changed of the structure and the factor 1 + x
Candidate relative_candidate(std::string name, double plausible,
                             std::function<fem::Structure(const fem::Structure&, double)> changed);

}  // namespace beamid::experiments
