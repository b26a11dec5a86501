// What a record determines, and what only in combination.
#pragma once

#include <Eigen/Core>

#include "filters/fisher_information.hpp"

namespace beamid::filters {

/// Fisher information about r unknowns c_i, seen in units d_i (`scale`), their sizes as guessed beforehand.
///
/// Along an eigenvector v of diag(d) I diag(d) with eigenvalue s, the combination sum v_i c_i / d_i cannot be
/// found to better than 1/sqrt(s).
struct InformationReport {
  Eigen::VectorXd scale;         ///< d (r)
  Eigen::VectorXd eigenvalues;   ///< s, largest first (r)
  Eigen::MatrixXd combinations;  ///< v in its columns, of length 1, largest entry positive (r x r)
  Eigen::Index rank = 0;         ///< how many combinations are determined: the first `rank`
  double condition = 0.0;        ///< largest / smallest eigenvalue; infinity when the rank is below r

  Eigen::VectorXd bounds;              ///< on each standard deviation; infinity where undetermined (r)
  Eigen::VectorXd conditional_bounds;  ///< the same were the others known: 1/sqrt(I_ii) (r)
  /// Of the best estimates, when all that is not determined is held fixed; 1 on the diagonal (r x r).
  Eigen::MatrixXd correlations;

  /// Whether unknown i is determined by itself: no undetermined combination holds it.
  bool determined(Eigen::Index i) const;
  /// Combinations about which the record says nothing (r x (r - rank)).
  Eigen::MatrixXd undetermined() const { return combinations.rightCols(combinations.cols() - rank); }
};

/// An unknown belongs to an undetermined combination when its entry there exceeds this; below it is rounding.
inline constexpr double negligible_entry = 1e-6;

/// @param threshold a combination counts as determined when sqrt(s) exceeds `threshold` times the largest:
/// what is below is rounding of the sensitivities.
/// @throws std::invalid_argument when the scale does not fit, is not positive and finite.
InformationReport determined_combinations(const InformationFactor& information, const Eigen::VectorXd& scale,
                                          double threshold = 1e-10);

/// The same of a matrix I (r x r), which has lost half the digits: hence the threshold.
/// @throws std::invalid_argument also when I is not square, finite, symmetric and positive semidefinite.
InformationReport determined_combinations(const Eigen::MatrixXd& information, const Eigen::VectorXd& scale,
                                          double threshold = 1e-6);

}  // namespace beamid::filters
