// The page "many degrees of freedom" of the atlas: chains, a frame and a beam under every discretisation.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/results.hpp"
#include "experiments/studies/atlas/unknown_family.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// A chain of `storeys` of the page, sampled every dt [s].
/// @param unknowns "all entries" of both symmetric matrices, "modes": frequency and damping of each;
/// "storeys": every spring and dashpot; "Rayleigh": springs, alpha and beta; "one ratio": springs and one
/// ratio of all modes. The damping is proportional to stiffness, 1 % in the first mode; of "one ratio", 1 %
/// in all.
UnknownFamily chain_family(int storeys, double dt, const std::string& unknowns);

/// Two storeys of steel, groups of columns and girders, a damping ratio for each of the first four modes.
UnknownFamily frame_family();

/// The beam S(11.8) on its mesh: E I and a damping ratio for each of the first three modes.
UnknownFamily beam_family();

/// One unknown under one scheme.
struct DegreesPoint {
  double law = 0.0;          ///< u_j of the law, projected on the family
  double first_terms = 0.0;  ///< of its first terms
  double found = 0.0;        ///< of the filter; NaN where it fails
  double by_dt_k = 0.0;      ///< what C + dt K would add to u_j
};

/// One family under one scheme.
struct DegreesCase {
  UnknownFamily family;
  std::string scheme;
  std::vector<DegreesPoint> points;  ///< of its parts

  /// Largest |found - law| of stiffness or of damping, over the largest |law - truth| of the same kind.
  double apart(bool damping) const;
  /// Of damping, over the largest change by dt K.
  double apart_of_dt_k() const;
};
DegreesCase degrees_case(const UnknownFamily& family, const std::string& scheme);

/// What is left of the error of damping once it is known; of each the largest relative one of a mode.
struct DegreesCure {
  std::string structure;
  double interval = 0.0, highest_step = 0.0;  ///< dt [s], w dt of the highest mode [rad]
  double found = 0.0;                         ///< of forward Euler's K_f and C_f
  double subtracted = 0.0;                    ///< of C_f - dt K_f
  double predicted = 0.0;                     ///< the remainder's first term, -C M^-1 C dt / 2
  double behind = 0.0;                        ///< of log(I + A_f dt) / dt
  double exact = 0.0;  ///< of the filter that moves by `exponential`; NaN where it was not run
};

/// One unknown of damping in noisy records.
struct DegreesNoise {
  std::string unknowns, filter, scheme, unknown;
  double bias = 0.0;        ///< mean error over seeds, over dt K
  double law = 0.0;         ///< over dt K
  double bias_bound = 0.0;  ///< mean error over the Cramer-Rao bound
  double scatter = 0.0;     ///< standard deviation over seeds, over the bound
};

struct DegreesPage {
  std::vector<DegreesCase> cases;        ///< every scheme
  std::vector<DegreesCase> projections;  ///< forward Euler, fewer unknowns of damping
  std::vector<DegreesCure> cures;
  std::vector<DegreesNoise> noisy;  ///< chain of three, extended and unscented filters
};

DegreesPage make_degrees_page(const Progress& progress);

/// Adds it: text, tables `many_degrees_damping`, `many_degrees_stiffness`, `fewer_damping_unknowns`, `cures`
/// and `noisy_records`, many_degrees_unknowns.csv.
void add_degrees_page(const DegreesPage& page, Results& results);

}  // namespace beamid::experiments
