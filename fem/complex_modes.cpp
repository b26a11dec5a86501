#include "fem/complex_modes.hpp"

// GCC 12 takes a vector that this header assigns in a loop for one used after it was freed.
#ifndef __clang__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <Spectra/GenEigsSolver.h>
#ifndef __clang__
#pragma GCC diagnostic pop
#endif

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "fem/modes.hpp"
#include "fem/response/dynamic_stiffness.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;

// (q, v) -> (-K^-1 (C q + M v), q), as Spectra wants it.
class InverseOperator {
 public:
  using Scalar = double;
  InverseOperator(const StructuralSystem& system, const StiffnessSolver& solver)
      : system_(system), solver_(solver), scale_(modes(system, 1).angular_frequency[0]) {}
  Index rows() const { return 2 * system_.size(); }
  Index cols() const { return rows(); }
  void perform_op(const double* in, double* out) const {
    const Index n = system_.size();
    const Eigen::Map<const VectorXd> q(in, n), v(in + n, n);
    const VectorXd force = system_.damping * q + scale_ * (system_.mass * v);
    Eigen::Map<VectorXd>(out, n) = -solver_.solve(force);
    Eigen::Map<VectorXd>(out + n, n) = q / scale_;
  }

 private:
  const StructuralSystem& system_;
  const StiffnessSolver& solver_;
  double scale_;
};

struct Pairs {
  VectorXcd inverse;  // 1 / lambda
  MatrixXcd vectors;  // (q, v)
};

Pairs all_pairs(const InverseOperator& op) {
  MatrixXd matrix(op.rows(), op.rows());
  VectorXd unit = VectorXd::Zero(op.rows());
  for (Index j = 0; j < op.rows(); ++j) {
    unit[j] = 1.0;
    op.perform_op(unit.data(), matrix.col(j).data());
    unit[j] = 0.0;
  }
  const Eigen::EigenSolver<MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success)
    throw std::runtime_error("complex modes: the dense eigensolver did not converge");
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Pairs largest_pairs(InverseOperator& op, Index count) {
  Spectra::GenEigsSolver<InverseOperator> solver(op, count,
                                                 std::min(op.rows(), std::max<Index>(2 * count + 2, 20)));
  solver.init();
  const Index found =
      solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-10, Spectra::SortRule::LargestMagn);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw std::runtime_error("complex modes: " + std::to_string(found) + " of " + std::to_string(count) +
                             " eigenvalues converged");
  return {solver.eigenvalues(), solver.eigenvectors()};
}

// Real and positive at its largest entry, so that what is printed does not depend on the eigensolver's phase.
void normalise(const StructuralSystem& system, VectorXcd& shape) {
  Index largest = 0;
  shape.cwiseAbs().maxCoeff(&largest);
  shape *= std::conj(shape[largest]) / std::abs(shape[largest]);
  shape[largest] = shape[largest].real();
  shape /= std::sqrt(shape.dot(system.mass * shape).real());
}

}  // namespace

VectorXd ComplexModes::frequency_hz() const {
  return eigenvalue.cwiseAbs() / (2.0 * std::numbers::pi);
}
VectorXd ComplexModes::damped_frequency_hz() const {
  return eigenvalue.imag() / (2.0 * std::numbers::pi);
}
VectorXd ComplexModes::damping_ratio() const {
  return -eigenvalue.real().cwiseQuotient(eigenvalue.cwiseAbs());
}

ComplexModes complex_modes(const StructuralSystem& system, Index count) {
  const Index n = system.size();
  if (count < 1 || count > n)
    throw std::invalid_argument("complex modes: count is " + std::to_string(count) + "; expected 1 to " +
                                std::to_string(n));
  const StiffnessSolver solver(system.stiffness);
  if (const Index rigid = solver.rigid_motions().cols(); rigid > 0)
    throw std::invalid_argument("complex modes: the structure can move without strain, in " +
                                std::to_string(rigid) + " ways; expected supports or springs that hold it");
  InverseOperator op(system, solver);
  const Index wanted = 2 * count + 1;  // both of every pair, and one more, for a pair may be cut in two
  const Pairs pairs = n <= 60 || 3 * wanted > op.rows() ? all_pairs(op) : largest_pairs(op, wanted);

  std::vector<ComplexPair> modes;
  constexpr double rounding = 1e-9;  // of a real root as the eigensolver finds it
  for (Index j = 0; j < pairs.inverse.size(); ++j) {
    Complex lambda = 1.0 / pairs.inverse[j];
    VectorXcd shape = pairs.vectors.col(j).tail(n);  // (q, v) = (lambda, 1) times the shape
    if (std::abs(lambda.imag()) <= rounding * std::abs(lambda)) lambda = lambda.real();
    if (lambda.imag() < 0.0) continue;
    modes.push_back({lambda, shape});
  }
  std::sort(modes.begin(), modes.end(),
            [](const auto& a, const auto& b) { return std::abs(a.lambda) < std::abs(b.lambda); });
  if (static_cast<Index>(modes.size()) > count) modes.resize(count);
  ComplexRefinement refinement(system, solver);
  for (ComplexPair& mode : modes) {
    refinement.refine(mode);
    if (!(mode.residual < 1e-4)) {
      std::ostringstream message;
      message << "complex modes: the mode at " << std::abs(mode.lambda) / (2.0 * std::numbers::pi)
              << " Hz has a relative residual of " << mode.residual << "; expected below 1e-4";
      throw std::runtime_error(message.str());
    }
  }
  std::sort(modes.begin(), modes.end(),
            [](const auto& a, const auto& b) { return std::abs(a.lambda) < std::abs(b.lambda); });

  ComplexModes result;
  const auto size = static_cast<Index>(modes.size());
  result.eigenvalue.resize(size);
  result.shape.resize(n, size);
  result.residual.resize(size);
  for (Index j = 0; j < size; ++j) {
    normalise(system, modes[j].shape);
    result.eigenvalue[j] = modes[j].lambda;
    result.shape.col(j) = modes[j].shape;
    result.residual[j] = modes[j].residual;
  }
  return result;
}

}  // namespace beamid::fem
