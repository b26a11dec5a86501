// The equations of motion of the whole mesh, sparse, at given values of the unknowns.
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/models/banded/banded_blocks.hpp"
#include "experiments/models/banded/banded_lanes.hpp"
#include "experiments/models/banded/strain_product.hpp"
#include "experiments/models/motion/parametric_motion.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments::banded {

// A(p) = A_0 + sum_j (p_j - p_0j) A_j by rows.

class ParametricRows {
 public:
  ParametricRows() = default;  ///< of nothing
  /// @param slopes A_j (a); an empty one is zero
  ParametricRows(const fem::SparseMatrix& reference, const std::vector<const fem::SparseMatrix*>& slopes);

  /// @param change p - p_0 (a)
  void set(const Eigen::VectorXd& change);

  const SparseRows& now() const { return now_; }
  const SparseRows& slope(Eigen::Index j) const { return slopes_[j]; }
  /// Coordinates [first, second) that A_j touches.
  std::pair<Eigen::Index, Eigen::Index> reach(Eigen::Index j) const { return reaches_[j]; }

 private:
  SparseRows reference_, now_;
  std::vector<SparseRows> slopes_;
  std::vector<EntryList> entries_;  // of the slopes in now_
  std::vector<std::pair<Eigen::Index, Eigen::Index>> reaches_;
};

// K(p) x without the assembled matrix, where strains are to be had.

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

// M(p) = M_0 + sum_j (p_j - p_0j) M_j as a band, or row by row.

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
