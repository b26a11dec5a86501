// Every diagonal matrix that gives a matrix a wanted spectrum.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// What was found of the k with spectrum(diag(k) A) = {lambda_1 ... lambda_n}.
struct SpectrumSolutions {
  std::vector<Eigen::VectorXd> positive;  ///< all k_i > 0, by rising k_1
  std::size_t complex_solutions = 0;      ///< n!: so many there are in the complex numbers, with multiplicity
  std::size_t found = 0;                  ///< of them, each proven to exist and to differ from the others

  /// Nothing can be missing.
  bool complete() const { return found == complex_solutions; }
};

/// Order up to which n! paths are affordable.
inline constexpr Eigen::Index most_paths_order = 8;

/// The multiplicative inverse eigenvalue problem [friedland1977]. Of a matrix with positive principal minors
/// the polynomials sum_{|S| = r} det(A_S) prod_{i in S} k_i = e_r(lambda) have no solution at infinity, hence
/// n! in all by Bezout's theorem. Their paths are followed from A = I, where they are the permutations of the
/// spectrum, along a line in the complex plane [morgan1987]; each end is certified by Kantorovich's theorem
/// [ortega1968], and two ends differ when their balls do (docs/theory/twins.md).
/// @param matrix (n x n) symmetric, positive definite; @param spectrum (n) positive
/// @throws std::invalid_argument when n is above most_paths_order or the sizes differ.
SpectrumSolutions spectrum_solutions(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& spectrum,
                                     const Progress& progress = unwatched);

}  // namespace beamid::experiments
