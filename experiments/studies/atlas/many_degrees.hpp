// The page "many degrees of freedom" of the atlas: chains, a frame and a beam under every discretisation.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"
#include "filters/measurements.hpp"
#include "filters/scheme_bias.hpp"

namespace beamid::experiments {

// A structure that rings down, its unknowns, and what filters that move by a scheme find.
//
// M x'' + C x' + K x = 0, its record exact. A filter looks for K and C within a family, affine in the
// unknowns,
//
//     K = K_0 + sum_j u_j K_j,    C = C_0 + sum_j u_j C_j
//
// The record belongs to K_f and C_f of the law (filters/scheme_bias.hpp). A complete family holds them, and
// the filter finds them. Of any other it finds what comes nearest in the record: with d = (K - K_f, C - C_f)
// and F the Fisher information of the record about all entries of K and C, the start being unknown,
//
//     d^T F d = min
//
// to first order in the misfit, a pole that d moves by a small part of its damping. For light damping and a
// long record F has two parts. Of the poles, mode k of amplitude a_k counts with W_k = |H phi_k a_k|^2 (S_2 -
// S_1^2 / S_0), S_m = sum_i t_i^m e^(-2 sigma_k t_i), times |phi_k^T (K - K_f) phi_k / 2 w_k|^2 + |phi_k^T (C
// - C_f) phi_k / 2|^2. Of the shapes it counts with S_0, which is smaller by 16 xi^2.

/// A structure with its record and its unknowns.
struct UnknownFamily {
  std::string structure;  ///< "chain of 3 storeys"
  std::string unknowns;   ///< "storeys", "all entries", "modes", ...
  filters::SecondOrder truth;
  Eigen::MatrixXd outputs;  ///< H: displacements observed (p x n)
  Eigen::VectorXd start;    ///< x at the release from rest (n)
  double interval = 0.0;    ///< dt [s]
  Eigen::Index samples = 0;
  bool velocities = false;  ///< H x' is observed beside H x
  double motion_noise =
      0.0;  ///< of the filter, process noise of x and x' / highest w, over the record's size
  Eigen::MatrixXd places = {};  ///< E of held forces, M x'' + C x' + K x = E f (n x m); none: a free decay
  Eigen::MatrixXd forces = {};  ///< f (m x N)

  struct Part {
    std::string name, unit;
    bool damping = false;    ///< of C, else of K
    double value = 0.0;      ///< u_j in truth
    double scale = 1.0;      ///< how far the filter may have to go
    double size = 1.0;       ///< of which errors are per cent
    Eigen::MatrixXd matrix;  ///< K_j or C_j (n x n)
  };
  std::vector<Part> parts;
  Eigen::MatrixXd fixed_damping, fixed_stiffness;  ///< C_0, K_0 (n x n); empty: zero
  bool complete = false;                           ///< K_f and C_f of every scheme are of this family

  filters::SecondOrder at(const Eigen::VectorXd& unknowns) const;
  Eigen::VectorXd values() const;
};

/// u_j whose K and C come nearest to given ones, a column for each: of a complete family the given ones; else
/// in the record, linearised at the truth (d^T F d).
Eigen::MatrixXd nearest(const UnknownFamily& family, const std::vector<filters::SecondOrder>& targets);

/// How a filter is run on a family's record.
struct FamilyRun {
  std::string filter = "ekf";
  double noise = 0.0;      ///< of displacements, over the record's largest; 0: exact, and R small
  std::uint64_t seed = 1;  ///< of the noise
};

/// What a filter really ends with, after several passes from the truth. Absent where it fails.
std::optional<Eigen::VectorXd> measured_unknowns(const UnknownFamily& family, const std::string& scheme,
                                                 const FamilyRun& how = {});

/// Cramer-Rao bound on the deviation of each u_j under such noise, the start being unknown (q).
Eigen::VectorXd bounds(const UnknownFamily& family, double noise);

/// The motion of a family's structure, exact: its free decay, with the response to held forces.
filters::Measurements exact_record(const UnknownFamily& family);

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
