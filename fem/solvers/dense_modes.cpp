#include "fem/solvers/dense_modes.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <stdexcept>

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Solver = Eigen::SelfAdjointEigenSolver<MatrixXd>;

// Z = L^-T V with M = L L^T, V orthonormal and orthogonal to L^T R.
MatrixXd complement_basis(const Eigen::LLT<MatrixXd>& mass, const RigidComplement& complement) {
  const Index n = mass.rows(), rigid = complement.count();
  if (rigid == 0) return mass.matrixU().solve(MatrixXd::Identity(n, n));
  const Eigen::HouseholderQR<MatrixXd> qr(mass.matrixU() * complement.modes());
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(n, n);
  return mass.matrixU().solve(q.rightCols(n - rigid));
}

// The upper half of the spectrum of [0 A; A^T 0] holds the singular values of A, with the right singular
// vectors in the lower part of its eigenvectors: as accurate as a singular value decomposition, whose
// templates take far longer to compile.
MatrixXd right_singular_vectors(const MatrixXd& a) {
  const Index s = a.rows(), n = a.cols();
  MatrixXd symmetric = MatrixXd::Zero(s + n, s + n);  // the solver reads its lower triangle only
  symmetric.bottomLeftCorner(n, s) = a.transpose();
  return Solver(symmetric).eigenvectors().bottomRightCorner(n, n);
}

MatrixXd shapes_from_flexibility(const StructuralSystem& system, const StiffnessSolver& solver,
                                 const RigidComplement& complement) {
  const Index n = system.size();
  MatrixXd flexibility = MatrixXd::Identity(n, n);
  for (Index i = 0; i < n; ++i) complement.project_load(flexibility.col(i));
  flexibility = solver.solve(flexibility);
  for (Index i = 0; i < n; ++i) complement.project_motion(flexibility.col(i));
  const Solver factors(0.5 * (flexibility + flexibility.transpose()));
  const VectorXd& values = factors.eigenvalues();
  if (!(values[0] > -1e-9 * values[n - 1]))
    throw std::runtime_error(
        "modes: with parts that have no mass, an axial load beyond buckling is not supported");
  const MatrixXd root = factors.eigenvectors() * values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const Solver modes(root.transpose() * (system.mass * root));  // ascending in 1/omega^2
  constexpr double no_mass = 1e-14;
  Index count = 0;
  while (count < n && modes.eigenvalues()[n - 1 - count] > no_mass * modes.eigenvalues()[n - 1]) ++count;
  return root * modes.eigenvectors().rightCols(count).rowwise().reverse();
}

}  // namespace

MatrixXd all_shapes(const StructuralSystem& system, const StiffnessSolver& solver,
                    const RigidComplement& complement) {
  const Eigen::LLT<MatrixXd> mass{MatrixXd(system.mass)};
  if (mass.info() != Eigen::Success) return shapes_from_flexibility(system, solver, complement);
  const MatrixXd basis = complement_basis(mass, complement), strain = system.stiffness.strain * basis;
  const Eigen::LLT<MatrixXd> rigidity{MatrixXd(system.stiffness.rigidity)};
  if (rigidity.info() == Eigen::Success) return basis * right_singular_vectors(rigidity.matrixU() * strain);
  return basis * Solver(strain.transpose() * (system.stiffness.rigidity * strain)).eigenvectors();
}

}  // namespace beamid::fem
