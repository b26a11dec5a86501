// K(p) = B^T D(p) B applied through its factors.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "experiments/models/banded/strain_product.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments::banded {

class BandedStiffness {
 public:
  /// @throws std::invalid_argument when D couples more strains than an element has.
  explicit BandedStiffness(const fem::ParametricSystem& equations);

  /// D = D_0 + sum_j change_j D_j (a).
  void set(const Eigen::VectorXd& change);

  /// y += K x; entries are double, Complex or Lanes.
  template <class Entry>
  void add_product(const Entry* x, Entry* y) const {
    current_(x, y);
  }
  /// y += K_j x
  template <class Entry>
  void add_slope_product(Eigen::Index j, const Entry* x, Entry* y) const {
    slopes_[j](x, y);
  }
  /// x^T K_j y, through the strains of both.
  double slope_form(Eigen::Index j, const double* x, const double* y) const { return slopes_[j].form(x, y); }

  /// Coordinates [first, second) that K_j touches.
  std::pair<Eigen::Index, Eigen::Index> reach(Eigen::Index j) const { return slopes_[j].reach(); }

 private:
  StrainProduct reference_, current_;
  std::vector<StrainProduct> slopes_;
};

}  // namespace beamid::experiments::banded
