// How much a record can tell at most.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "filters/discrete_model.hpp"

namespace beamid::filters {

// Fisher information as a triangular factor, which keeps the digits that the matrix would lose.

/// I = U^T U about r unknowns, U (r x r) upper triangular, from whitened sensitivities row after row.
///
/// Unknowns of different kinds (a stiffness, a start) differ by many orders of magnitude. Forming I squares
/// that range; the QR decomposition of the sensitivities themselves does not [bierman1977, ch. V].
class InformationFactor {
 public:
  explicit InformationFactor(Eigen::Index unknowns);

  /// Appends sensitivities L^-1 dy/dc (k x r) of outputs whose noise is R = L L^T.
  /// @throws std::invalid_argument when they have another number of columns, or are not finite.
  void add(const Eigen::MatrixXd& whitened);

  Eigen::Index unknowns() const { return rows_.cols(); }  ///< r
  Eigen::MatrixXd root() const;                           ///< U (r x r)
  Eigen::MatrixXd information() const;                    ///< U^T U (r x r), exactly symmetric

  /// The information about the others when these are unknown too: the Schur complement
  /// I_22 - I_21 I_11^-1 I_12, by orthogonal transformation and not by that difference. Unknowns to eliminate
  /// that the record says nothing about cost nothing.
  /// @throws std::invalid_argument when an index does not exist, or nothing would remain.
  InformationFactor without(const std::vector<Eigen::Index>& nuisances) const;

 private:
  static constexpr Eigen::Index block_ = 256;  // rows gathered before each decomposition
  Eigen::MatrixXd rows_;                       // U above, rows not yet worked in below
  Eigen::Index used_ = 0;                      // how many of them count
};

/// Fisher information (n x n) about the initial state z_0 (parameters included) in `samples` outputs of a
/// motion without process noise that starts at z_0, noise R on the outputs, no prior [kay1993, ch. 3]:
///
///     I = sum_k (H_k T_k)^T R^-1 (H_k T_k),   T_k = J_k-1 ... J_0
Eigen::MatrixXd fisher_information(DiscreteModel& model, const Eigen::VectorXd& initial_state,
                                   Eigen::Index samples);

/// The same about the r coefficients c of z_0 = initial_state + S_0 c, S_0 = directions (n x r), as a factor
/// that keeps the digits: for states of thousands of entries of which few combinations are unknown.
///
///     I = sum_k (H_k S_k)^T R^-1 (H_k S_k),   S_k+1 = J_k S_k by DiscreteModel::move()
///
/// @param inputs u_k in its columns, as DiscreteModel takes them (m (d + 1) x samples); empty: none.
/// @throws std::invalid_argument when shapes disagree or R is not positive definite; std::runtime_error when
/// the motion or its sensitivities do not remain finite.
InformationFactor information_factor(DiscreteModel& model, const Eigen::VectorXd& initial_state,
                                     Eigen::Index samples, const Eigen::MatrixXd& directions,
                                     const Eigen::MatrixXd& inputs = {});

/// information_factor(...).information() (r x r).
Eigen::MatrixXd fisher_information(DiscreteModel& model, const Eigen::VectorXd& initial_state,
                                   Eigen::Index samples, const Eigen::MatrixXd& directions,
                                   const Eigen::MatrixXd& inputs = {});

/// Cramer-Rao bound on the standard deviation of every entry of z_0: sqrt of the diagonal of I^-1 (n).
/// @throws std::invalid_argument when the information is singular: some combination is not determined.
/// filters/identifiability.hpp says which.
Eigen::VectorXd cramer_rao_bound(const Eigen::MatrixXd& information);

}  // namespace beamid::filters
