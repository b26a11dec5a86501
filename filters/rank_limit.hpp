// Factors of covariances cut back to a rank.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace beamid::filters {

/// Cuts factors back to a number of columns, and keeps account of the variance that this drops.
///
/// Rows are weighed by their own deviations, so that no unit counts for more than another:
/// D^-1 L = U diag(s) V^T is replaced by its first `rank` terms. A factor with as many columns allowed as it
/// has rows loses nothing: it is turned into a lower triangle.
class RankLimit {
 public:
  /// @param rank largest number of columns; 0: chosen by start(). @throws std::invalid_argument
  RankLimit(double rank, const std::string& owner);

  /// Called with every initial factor. A chosen rank is n where n <= 64, so that small models lose nothing,
  /// and else the columns of this factor.
  void start(Eigen::MatrixXd& factor);
  void operator()(Eigen::MatrixXd& factor);

  Eigen::Index rank() const { return rank_; }
  double largest_share() const { return largest_share_; }  ///< of an entry's variance, dropped in one step
  double dropped() const { return dropped_; }  ///< sum over steps of the dropped share of all variances
  std::vector<std::string> remarks() const;    ///< none where nothing beyond rounding was dropped

 private:
  void cut(Eigen::MatrixXd& factor);

  Eigen::Index asked_, rank_ = 0, steps_ = 0;
  double largest_share_ = 0.0, dropped_ = 0.0;
  Eigen::VectorXd deviation_;
  Eigen::MatrixXd scaled_;
};

}  // namespace beamid::filters
