
#include "experiments/studies/reduce/report.hpp"

#include <cmath>
#include <limits>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

MatrixXd squared_cosines(const MatrixXd& products, const VectorXd& phi, const VectorXd& psi) {
  return phi.cwiseInverse().asDiagonal() * products.cwiseAbs2() * psi.cwiseInverse().asDiagonal();
}

}  // namespace

MatrixXd mac(const MatrixXd& phi, const MatrixXd& psi, const fem::SparseMatrix& mass) {
  const MatrixXd weighted = mass * psi;
  return squared_cosines(phi.transpose() * weighted, phi.cwiseProduct(mass * phi).colwise().sum(),
                         psi.cwiseProduct(weighted).colwise().sum());
}

MatrixXd mac(const MatrixXd& phi, const MatrixXd& psi) {
  return squared_cosines(phi.transpose() * psi, phi.colwise().squaredNorm(), psi.colwise().squaredNorm());
}

std::vector<Index> partners(const MatrixXd& mac) {
  std::vector<Index> found;
  for (Index i = 0; i < mac.rows(); ++i) {
    Index best = -1;
    if (mac.cols() > 0 && !(mac.row(i).maxCoeff(&best) > 0.5)) best = -1;
    found.push_back(best);
  }
  return found;
}

VectorXd comac(const MatrixXd& phi, const MatrixXd& psi) {
  VectorXd found = VectorXd::Constant(phi.rows(), std::numeric_limits<double>::quiet_NaN());
  if (phi.cols() < 2) return found;
  for (Index p = 0; p < phi.rows(); ++p) {
    const double product = phi.row(p).cwiseAbs().dot(psi.row(p).cwiseAbs());
    const double squares = phi.row(p).squaredNorm() * psi.row(p).squaredNorm();
    if (squares > 0.0) found[p] = product * product / squares;
  }
  return found;
}

LowestComac lowest_comac(const VectorXd& comac) {
  LowestComac found{std::numeric_limits<double>::quiet_NaN(), -1};
  for (Index p = 0; p < comac.size(); ++p)
    if (!std::isnan(comac[p]) && !(comac[p] >= found.value)) found = {comac[p], p};
  if (found.value > 1.0 - 1e-9) found.point = -1;
  return found;
}

}  // namespace beamid::experiments
