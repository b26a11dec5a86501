// The equations of motion of the whole mesh, sparse, at given values of the unknowns.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/models/banded/banded_mass.hpp"
#include "experiments/models/banded/banded_stiffness.hpp"
#include "experiments/models/banded/parametric_rows.hpp"
#include "experiments/models/banded/symmetric_pattern.hpp"
#include "experiments/models/motion/parametric_motion.hpp"

namespace beamid::experiments::banded {

/// M(p), C(p), K(p), E(p) f and their derivatives, each applied in O(n),
///
///     C = C_0 + sum_j (p_j - p_0j) C_j + alpha M + beta K + sum_i c_i g_i g_i^T,
///
/// whatever the structure: along a beam all matrices are narrow bands, of frames and of a user's own matrices
/// they are sparse.
class BandedEquations {
 public:
  /// @throws std::invalid_argument when sizes do not fit.
  BandedEquations(const fem::ParametricSystem& equations, const MotionDescription& description);

  Eigen::Index size() const { return size_; }                                                  ///< n
  Eigen::Index properties() const { return static_cast<Eigen::Index>(force_slopes_.size()); }  ///< a
  const SymmetricPattern& pattern() const { return pattern_; }                                 ///< of S

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

  /// C_0 + sum_j change_j C_j, and C_j.
  const ParametricRows& dashpots() const { return dashpots_; }

  /// S = (1 + lambda beta) K + lambda C_0 + (lambda alpha + lambda^2) M on the pattern, single modes left
  /// out.
  void assemble(const Complex& lambda, std::vector<Complex>& entries) const;
  /// The square of the highest natural frequency of the mesh, its order of magnitude: the largest K_ii / M_ii
  /// at p_0 [1/s2].
  double highest_squared_frequency() const;
  /// M on the pattern.
  const std::vector<double>& mass_entries() const { return mass_entries_.now; }

 private:
  /// K, M or C on the pattern: at p_0, its derivatives, and at p.
  struct Entries {
    std::vector<double> reference, now;
    std::vector<EntryList> slopes;
    bool is_constant = true;

    Entries(const SymmetricPattern& pattern, const std::vector<fem::SparseMatrix>& matrices);
    void set(const Eigen::VectorXd& change);
  };
  /// Each of them and its derivatives (1 + a).
  struct Assembled {
    std::vector<fem::SparseMatrix> stiffness, mass, dashpots;

    explicit Assembled(const fem::ParametricSystem& equations);
    SymmetricPattern pattern() const;
  };
  BandedEquations(const fem::ParametricSystem& equations, const MotionDescription& description,
                  const Assembled& assembled);

  MotionDescription description_;
  Eigen::Index size_;
  BandedStiffness stiffness_;
  BandedMass mass_;
  SymmetricPattern pattern_;
  Entries stiffness_entries_, mass_entries_, dashpot_entries_;
  ParametricRows dashpots_;
  fem::SparseMatrix force_;
  std::vector<fem::SparseMatrix> force_slopes_;

  bool is_set_ = false;
  Eigen::VectorXd change_, ratios_;
  double mass_damping_ = 0.0, stiffness_damping_ = 0.0;
  std::vector<ModeDamping> mode_dampings_;
};

}  // namespace beamid::experiments::banded
