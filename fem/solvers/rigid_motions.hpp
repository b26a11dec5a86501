// How a structure can move without strain.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/solvers/strain_sweeps.hpp"

namespace beamid::fem {

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
