#include "fem/modes.hpp"

#include <Spectra/SymGEigsShiftSolver.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

#include "fem/stiffness_solver.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// What Spectra wants of (K - 0 M)^-1 and of M.
class InverseStiffness {
 public:
  using Scalar = double;
  explicit InverseStiffness(const StructuralSystem& system)
      : size_(system.size()), solver_(system.stiffness) {}
  Index rows() const { return size_; }
  Index cols() const { return size_; }
  void set_shift(double) {}  // always zero
  void perform_op(const double* in, double* out) const {
    Eigen::Map<VectorXd>(out, size_) = solver_.solve(Eigen::Map<const VectorXd>(in, size_));
  }

 private:
  Index size_;
  StiffnessSolver solver_;
};

class Mass {
 public:
  using Scalar = double;
  explicit Mass(const SparseMatrix& mass) : mass_(mass) {}
  Index rows() const { return mass_.rows(); }
  Index cols() const { return mass_.cols(); }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<VectorXd>(out, mass_.rows()) = mass_ * Eigen::Map<const VectorXd>(in, mass_.rows());
  }

 private:
  const SparseMatrix& mass_;
};

MatrixXd lowest_shapes(const StructuralSystem& system, Index count) {
  InverseStiffness inverse(system);
  Mass mass(system.mass);
  const Index subspace = std::min(system.size(), std::max<Index>(2 * count + 1, 20));
  Spectra::SymGEigsShiftSolver<InverseStiffness, Mass, Spectra::GEigsMode::ShiftInvert> solver(
      inverse, mass, count, subspace, 0.0);
  solver.init();
  const Index found =
      solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-13, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw std::runtime_error("modes: " + std::to_string(found) + " of " + std::to_string(count) +
                             " eigenvalues converged");
  return solver.eigenvectors();
}

// M = L L^T and D = R^T R: the singular values of F = R B L^-T are the frequencies, v = L^T phi. They are the
// upper half of the spectrum of [0 F; F^T 0], with v in the lower half of its eigenvectors: as accurate as a
// singular value decomposition, whose templates take far longer to compile.
MatrixXd all_shapes(const StructuralSystem& system) {
  const Eigen::LLT<MatrixXd> mass{MatrixXd(system.mass)};
  const Eigen::LLT<MatrixXd> rigidity{MatrixXd(system.stiffness.rigidity)};
  if (mass.info() != Eigen::Success)
    throw std::runtime_error("modes: the mass matrix is not positive definite");
  const MatrixXd strain = rigidity.matrixU() * MatrixXd(system.stiffness.strain);
  const Index s = strain.rows(), n = strain.cols();
  MatrixXd symmetric = MatrixXd::Zero(s + n, s + n);  // the solver reads its lower triangle only
  symmetric.bottomLeftCorner(n, s) = mass.matrixL().solve(strain.transpose());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric);
  return mass.matrixU().solve(solver.eigenvectors().bottomRightCorner(n, n));
}

}  // namespace

VectorXd Modes::frequency_hz() const {
  return angular_frequency / (2.0 * std::numbers::pi);
}

Modes modes(const StructuralSystem& system, Index count) {
  const Index n = system.size();
  if (count < 1 || count > n)
    throw std::invalid_argument("modes: count is " + std::to_string(count) + "; expected 1 to " +
                                std::to_string(n));
  const bool few = 3 * count < n && n > 60;
  Modes result;
  result.shape = few ? lowest_shapes(system, count) : MatrixXd(all_shapes(system).leftCols(count));
  result.angular_frequency.resize(count);
  result.residual.resize(count);
  const StiffnessSolver solver(system.stiffness);
  for (Index i = 0; i < count; ++i) {
    auto shape = result.shape.col(i);
    shape /= std::sqrt(shape.dot(system.mass * shape));
    const double square = system.stiffness.energy(shape);
    result.angular_frequency[i] = std::sqrt(square);
    const VectorXd difference = shape - square * solver.solve(system.mass * shape);
    result.residual[i] = std::sqrt(difference.dot(system.mass * difference));
    if (few && !(result.residual[i] < 1e-4)) {  // what Lanczos calls converged need not be a mode
      std::ostringstream message;
      message << "modes: mode " << i + 1 << " has a relative residual of " << result.residual[i]
              << "; masses or stiffnesses are too far apart for double precision";
      throw std::runtime_error(message.str());
    }
  }
  return result;
}

}  // namespace beamid::fem
