// The equations of motion of the whole mesh as narrow bands, at given values of the unknowns.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "experiments/models/banded/banded_factor.hpp"
#include "experiments/models/banded/banded_mass.hpp"
#include "experiments/models/banded/banded_stiffness.hpp"
#include "experiments/models/motion/parametric_motion.hpp"

namespace beamid::experiments::banded {

/// M(p), C(p), K(p), E(p) f and their derivatives, each applied in O(n),
///
///     C = C_0 + alpha M + beta K + sum_i c_i g_i g_i^T.
class BandedEquations {
 public:
  /// @throws std::invalid_argument when sizes do not fit, or bands are wider than BandedFactor::widest.
  BandedEquations(const fem::ParametricSystem& equations, const MotionDescription& description);

  Eigen::Index size() const { return size_; }                                                  ///< n
  Eigen::Index properties() const { return static_cast<Eigen::Index>(force_slopes_.size()); }  ///< a
  int width() const { return width_; }  ///< of S, as BandedFactor stores it

  /// Takes the values of the unknowns. @return whether anything is other than before.
  bool set(const PhysicalValues& values);

  const BandedStiffness& stiffness() const { return stiffness_; }
  const BandedMass& mass() const { return mass_; }
  const Eigen::VectorXd& change() const { return change_; }        ///< p - p_0 (a)
  double mass_damping() const { return mass_damping_; }            ///< alpha
  double stiffness_damping() const { return stiffness_damping_; }  ///< beta
  const std::vector<DampedMode>& damped_modes() const { return description_.damped_modes; }
  const std::vector<ModeDamping>& mode_dampings() const { return mode_dampings_; }

  /// E f (n) for measured forces f (m).
  Eigen::VectorXd force(const Eigen::VectorXd& input) const;
  /// E_j f (n)
  Eigen::VectorXd force_slope(Eigen::Index j, const Eigen::VectorXd& input) const;
  bool force_depends_on(Eigen::Index j) const { return force_slopes_[j].nonZeros() > 0; }
  /// y += C_0 v
  template <class Entry>
  void add_dashpots(const Entry* v, Entry* y) const {
    for (int j = 0; j < dashpots_.outerSize(); ++j)
      for (fem::SparseMatrix::InnerIterator it(dashpots_, j); it; ++it) y[it.row()] += it.value() * v[j];
  }

  /// Row by row S = (1 + lambda beta) K + lambda C_0 + (lambda alpha + lambda^2) M, single modes left out.
  void assemble(const Complex& lambda, BandedFactor& factor) const;

 private:
  MotionDescription description_;
  Eigen::Index size_;
  BandedStiffness stiffness_;
  BandedMass mass_;
  int width_;
  // Lower triangles, width_ + 1 entries per row, of K_0 and K_j over the rows that K_j reaches, and of C_0.
  std::vector<double> stiffness_band_, dashpot_band_;
  std::vector<std::vector<double>> stiffness_slopes_;
  fem::SparseMatrix dashpots_, force_;
  std::vector<fem::SparseMatrix> force_slopes_;

  bool is_set_ = false;
  Eigen::VectorXd change_, ratios_;
  double mass_damping_ = 0.0, stiffness_damping_ = 0.0;
  std::vector<ModeDamping> mode_dampings_;
  std::vector<double> band_;  // K(p)
};

}  // namespace beamid::experiments::banded
