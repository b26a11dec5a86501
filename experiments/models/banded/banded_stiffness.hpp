// K(p) x without the assembled matrix, where strains are to be had.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "experiments/models/banded/parametric_rows.hpp"
#include "experiments/models/banded/strain_product.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments::banded {

/// K(p) = K_0 + sum_j change_j K_j through the strains of the elements, which keeps its digits. Matrices that
/// come without elements ([system]) have no strains: theirs are as good as the digits of K itself, which
/// multiplies row by row then.
class BandedStiffness {
 public:
  explicit BandedStiffness(const fem::ParametricSystem& equations);

  /// @param change p - p_0 (a)
  void set(const Eigen::VectorXd& change);

  /// y += K x; entries are double, Complex or Lanes.
  template <class Entry>
  void add_product(const Entry* x, Entry* y) const {
    if (form_ == Form::rows) rows_.now().add_product(x, y);
    for (const StrainProduct& product : current_) product(x, y);
  }
  /// y += K_j x
  template <class Entry>
  void add_slope_product(Eigen::Index j, const Entry* x, Entry* y) const {
    if (form_ == Form::rows)
      rows_.slope(j).add_product(x, y);
    else
      slopes_[j](x, y);
  }
  /// total += x^T K_j y for four x at a time, through the strains of all.
  void add_slope_form(Eigen::Index j, const Lanes* x, const double* y, Lanes& total) const {
    if (form_ == Form::rows)
      rows_.slope(j).add_form(x, y, total);
    else
      slopes_[j].add_form(x, y, total);
  }

  /// Coordinates [first, second) that K_j touches.
  std::pair<Eigen::Index, Eigen::Index> reach(Eigen::Index j) const {
    return form_ == Form::rows ? rows_.reach(j) : slopes_[j].reach();
  }

 private:
  void take_strains(const fem::ParametricSystem& equations, const std::vector<int>& own_starts,
                    const std::vector<int>& starts);
  void take_rows(const fem::ParametricSystem& equations);

  enum class Form {
    one_set_of_strains,  ///< D(p) = D_0 + sum_j change_j D_j between the same B
    two_sets,            ///< K_0 and the K_j apart: the D_j are about strains that K_0 does without
    rows                 ///< assembled
  };
  Form form_ = Form::one_set_of_strains;
  StrainProduct reference_;
  std::vector<StrainProduct> slopes_, current_;  // K_j; K is the sum of the latter
  ParametricRows rows_;
};

}  // namespace beamid::experiments::banded
