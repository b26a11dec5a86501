// Every set of parameters that explains the modes as well.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/identify/update/modal_model.hpp"
#include "experiments/identify/update/updating.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

// Every diagonal matrix that gives a matrix a wanted spectrum.

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

/// How a list of sets was found, and whether it can lack one.
struct TwinSearch {
  enum class Method {
    all_solutions,  ///< every complex solution of the polynomials was found (twins.hpp)
    starts          ///< searches from many starts
  };
  Method method = Method::starts;
  std::string reason = {};                       ///< why not all_solutions, a clause
  std::size_t complex_solutions = 0, found = 0;  ///< all_solutions
  std::vector<Eigen::VectorXd> values = {};      ///< (q) that meet all frequencies exactly
  bool complete() const { return method == Method::all_solutions && found == complex_solutions; }
};

/// The sets that meet the measured frequencies exactly, all of them, where the structure is one of n springs
/// on n degrees of freedom with known masses, every spring is asked about by itself, and all n frequencies
/// were measured: a chain storey by storey. Elsewhere no values, and the reason.
TwinSearch exact_twins(const ModalModel& model, const ModalData& data, const Progress& progress = unwatched);

/// Whether [[parameters]] asks about a stiffness by this quantity, of which there may be twins.
bool is_stiffness(const std::string& quantity);

/// Probability that one more start would end at a set not seen yet [good1953]: sets seen once, over starts.
double unseen_probability(const Updating& updating);
/// Whether that is above a half: nearly every start ended at a place of its own.
bool starts_say_little(const Updating& updating);

}  // namespace beamid::experiments
