// Sweeps along a chain: coordinates from strains, natural forces from loads.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "fem/solvers/rigid_complement.hpp"

namespace beamid::fem {

/// The triangular part of the strains B (s x n), found by walking its rows in order. Of the coordinates in a
/// row that no earlier row has determined, the last one is determined by this row; any others become gauges,
/// coordinates that only the rest of the structure can fix (the root's rotation of a pinned beam, both of the
/// root's of a free one). A row without undetermined coordinates is redundant (the far clamp of a clamped
/// beam, an interior support). In the order of the determining rows,
///
///     B = [ B_d  B_g ]   determining rows, B_d lower triangular
///         [ R_d  R_g ]   redundant rows
///
/// so that for a chain, which has few gauges and redundants, B_d^-1 and B_d^-T are cumulative sums along it.
class StrainSweeps {
 public:
  explicit StrainSweeps(const Eigen::SparseMatrix<double>& strain);

  const std::vector<int>& gauges() const { return gauges_; }          ///< coordinates, ascending per row
  const std::vector<int>& redundants() const { return redundants_; }  ///< rows, ascending
  Eigen::Index coordinates() const { return coordinates_; }           ///< n

  /// Rows that determine a coordinate each.
  Eigen::Index steps() const { return rows_.size(); }

  /// q_d = B_d^-1 (e_d - B_g q_g), first row to last. `strain_of(row)` gives e; q (n) holds q_g on entry.
  template <class StrainOf>
  void sweep_forward(StrainOf&& strain_of, double* q) const {
    for (Eigen::Index step = 0; step < steps(); ++step) {
      double* const place = q + pivot_[step];
      const RepeatedRows::Entry *entry = rows_.begin(step), *last = rows_.end(step);
      double rest = strain_of(row_[step]) * entry->value;
      while (++entry != last) rest -= entry->value * place[entry->offset];
      *place = rest;
    }
  }

  /// The same without strain. A sum that cancels to rounding is zero: a fused multiplication would leave the
  /// rounding error of a product, and a redundant row of nothing else would seem to strain.
  void sweep_motion(double* q) const;

  /// sweep_forward() with the rounding errors of the sums carried along in `low` (n), all zero on entry.
  /// Uncarried they are small but lean to one side over long stretches, and a chain of a million coordinates
  /// adds them up twice.
  template <class StrainOf>
  void sweep_forward_compensated(StrainOf&& strain_of, double* q, double* low) const {
    for (Eigen::Index step = 0; step < steps(); ++step) {
      double *const place = q + pivot_[step], *const low_place = low + pivot_[step];
      const RepeatedRows::Entry *entry = rows_.begin(step), *last = rows_.end(step);
      double rest = strain_of(row_[step]) * entry->value, error = 0.0;
      while (++entry != last) {
        const double term = -entry->value * place[entry->offset], sum = rest + term, back = sum - rest;
        error += (rest - (sum - back)) + (term - back) - entry->value * low_place[entry->offset];
        rest = sum;
      }
      const double sum = rest + error;
      *place = sum;
      *low_place = error - (sum - rest);
    }
  }

  /// N_d = B_d^-T f_d, last row to first, into forces (s), whose redundant entries are left alone. Of the
  /// load f (n) it leaves at the gauges what the forces do not balance there, f_g - B_g^T N_d.
  void sweep_backward(double* f, double* forces) const;

 private:
  Eigen::Index coordinates_;
  RepeatedRows
      rows_;  // per step: the inverse of the pivot, then the other entries, placed at the pivot's column
  std::vector<int> row_, pivot_;  // of each step
  std::vector<int> gauges_, redundants_;
};

// How a structure can move without strain.

/// What the redundant rows of the strains say about the gauges (strain_sweeps.hpp). Moving one gauge by 1,
/// with no strain in any determining row, is a motion u_g = -B_d^-1 B_g of the whole, and strains the
/// redundant rows by W = R_g + R_d u_g. Gauges whose motions W tells apart are `kept` unknowns; the others
/// are `held` at zero, and for each of them there is a rigid-body motion. The decision looks at lengths only,
/// whatever the stiffnesses: it is made by a QR decomposition of W after its columns are divided by the
/// largest motion and its rows by the sums of the magnitudes of their terms.
struct RigidMotions {
  std::vector<int> kept, held;  ///< coordinates
  Eigen::MatrixXd constraint;   ///< W (redundants x kept)
  Eigen::MatrixXd motions;      ///< basis of the rigid-body motions (n x held), largest entry of each 1
};

RigidMotions rigid_motions(const StrainSweeps& sweeps, const Eigen::SparseMatrix<double>& strain);

/// The rows of B that `rows` names.
Eigen::SparseMatrix<double, Eigen::RowMajor> selected_rows(const Eigen::SparseMatrix<double>& strain,
                                                           const std::vector<int>& rows);

}  // namespace beamid::fem
