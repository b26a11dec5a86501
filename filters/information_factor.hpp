// Fisher information as a triangular factor, which keeps the digits that the matrix would lose.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamid::filters {

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

}  // namespace beamid::filters
