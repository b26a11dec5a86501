// M(p) = M_0 + sum_j (p_j - p_0j) M_j as a band, or row by row.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/models/banded/banded_lanes.hpp"
#include "experiments/models/banded/parametric_rows.hpp"
#include "experiments/models/banded/symmetric_pattern.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments::banded {

class BandedMass {
 public:
  explicit BandedMass(const fem::ParametricSystem& equations);

  /// @param change p - p_0 of the properties (a)
  void set(const Eigen::VectorXd& change);

  /// y = M x; entries are double or Lanes.
  void multiply(const double* x, double* y) const;
  void multiply(const Lanes* x, Lanes* y) const;
  /// y -= M x
  void take_off(const Complex* x, Complex* y) const;
  /// Entries of M_j, of both triangles.
  struct Entry {
    Eigen::Index row, column;
    double value;
  };
  const std::vector<Entry>& slope(Eigen::Index j) const { return slopes_[j]; }
  bool is_constant() const { return support_.empty(); }
  /// Coordinates that any M_j touches, ascending (s).
  const std::vector<Eigen::Index>& support() const { return support_; }

 private:
  bool is_band() const { return width_ <= narrow_band; }
  std::size_t place(Eigen::Index row, Eigen::Index column) const {
    return static_cast<std::size_t>(row * (2 * width_ + 1) + width_ + column - row);
  }

  Eigen::Index size_;
  int width_ = 0;  // entries beside the diagonal
  std::vector<double> reference_, band_;
  ParametricRows rows_;  // where it is no band
  std::vector<std::vector<Entry>> slopes_;
  std::vector<Eigen::Index> support_;
};

}  // namespace beamid::experiments::banded
