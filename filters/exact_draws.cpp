#include "filters/exact_draws.hpp"

#include <Eigen/QR>
#include <cmath>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd;

Draws exact_draws(RandomStream& random, Index rows, Index count, const MatrixXd& others) {
  Draws draws{random.normal(rows, count), false};
  if (count < rows + others.rows() + 1) {
    const Eigen::VectorXd mean = draws.values.rowwise().mean();
    draws.values.colwise() -= mean;
    return draws;
  }
  // Columns 1, others^T, draws^T: the last of an orthonormal basis are the draws, freed of all before them.
  MatrixXd all(count, 1 + others.rows() + rows);
  all << Eigen::VectorXd::Ones(count), others.transpose(), draws.values.transpose();
  for (Index j = 0; j < all.cols(); ++j)
    if (const double norm = all.col(j).norm(); norm > 0.0) all.col(j) /= norm;
  const Eigen::HouseholderQR<MatrixXd> qr(all);
  MatrixXd basis = MatrixXd::Zero(count, rows);
  basis.bottomRows(count - all.cols() + rows).topRows(rows).setIdentity();
  basis.applyOnTheLeft(qr.householderQ());
  // The sign of each is that of the draw, so that nothing but its length and correlations changes.
  for (Index j = 0; j < rows; ++j)
    if (basis.col(j).dot(draws.values.row(j)) < 0.0) basis.col(j) = -basis.col(j);
  draws.values = std::sqrt(static_cast<double>(count - 1)) * basis.transpose();
  draws.exact = true;
  return draws;
}

}  // namespace beamid::filters
