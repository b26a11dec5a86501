// Products with a matrix that is dense in form and mostly 0.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamid::filters {

/// The entries of a matrix A (m x n) that are not 0. A tangent of decoupled oscillators has two in a row and
/// one for each unknown, so that a product with it costs a tenth of the dense one.
class NonZeros {
 public:
  /// Whether A has few enough, a quarter at most, for products by entry to be the faster ones; the entries
  /// are only kept where it has.
  bool take(const Eigen::Ref<const Eigen::MatrixXd>& a);

  /// out = B A^T (r x m), of B (r x n).
  void from_right(const Eigen::MatrixXd& b, Eigen::MatrixXd& out) const;
  /// out = A B (m x r), of B (n x r).
  void from_left(const Eigen::MatrixXd& b, Eigen::MatrixXd& out) const;

 private:
  struct Entry {
    Eigen::Index row, column;
    double value;
  };
  std::vector<Entry> entries_;
  Eigen::Index rows_ = 0;
};

}  // namespace beamid::filters
