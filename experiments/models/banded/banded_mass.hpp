// M(p) = M_0 + sum_j (p_j - p_0j) M_j as a band.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/models/banded/banded_lanes.hpp"
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
  /// Entries beside the diagonal.
  int width() const { return width_; }
  /// Row i from column i - width() on; zero beyond the matrix.
  const double* row(Eigen::Index i) const { return &band_[static_cast<std::size_t>(i) * (2 * width_ + 1)]; }

  /// M_j is small or nothing: its entries. Both triangles are there.
  struct Entry {
    Eigen::Index row, column;
    double value;
  };
  const std::vector<Entry>& slope(Eigen::Index j) const { return slopes_[j]; }
  bool is_constant() const { return support_.empty(); }
  /// Coordinates that any M_j touches, ascending (s).
  const std::vector<Eigen::Index>& support() const { return support_; }

 private:
  Eigen::Index size_;
  int width_ = 0;
  std::vector<double> reference_, band_;
  std::vector<std::vector<Entry>> slopes_;
  std::vector<Eigen::Index> support_;
};

}  // namespace beamid::experiments::banded
