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
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "filters/measurements.hpp"
#include "filters/scheme_bias.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
