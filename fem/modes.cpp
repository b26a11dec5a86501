#include "fem/modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SparseLU>

#include "fem/solvers/rigid_complement.hpp"
#include "fem/stiffness_solver.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {
namespace {

// All modes of a small system.

/// Shapes (n x m) of all modes that are not rigid, frequencies ascending; m is n less the rigid-body motions
/// and less what has no mass.
///
/// With Z (n x (n-k)) an M-orthonormal basis of the complement of the rigid-body motions and D = U^T U, they
/// are Z times the right singular vectors of U B Z, whose singular values are the frequencies themselves and
/// not their squares. Where an axial load has made D indefinite, Z times the eigenvectors of (B Z)^T D (B Z).
/// Where M is only semidefinite, eigenvectors of the flexibility K^-1 against M.
Eigen::MatrixXd all_shapes(const StructuralSystem& system, const StiffnessSolver& solver,
                           const RigidComplement& complement);

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

MatrixXd all_shapes(const StructuralSystem& system, const StiffnessSolver& solver,
                    const RigidComplement& complement) {
  const Eigen::LLT<MatrixXd> mass{MatrixXd(system.mass)};
  if (mass.info() != Eigen::Success) return shapes_from_flexibility(system, solver, complement);
  const MatrixXd basis = complement_basis(mass, complement), strain = system.stiffness.strain * basis;
  const Eigen::LLT<MatrixXd> rigidity{MatrixXd(system.stiffness.rigidity)};
  if (rigidity.info() == Eigen::Success) return basis * right_singular_vectors(rigidity.matrixU() * strain);
  return basis * Solver(strain.transpose() * (system.stiffness.rigidity * strain)).eigenvectors();
}

// Below this residual the complementary quotient, which errs by its square, is the better one.
constexpr double converged = 1e-6;
constexpr double largest_residual = 1e-4;  // of what Lanczos may return

// Normalises the shape of mode i and fills in what is told of it.
class Appraisal {
 public:
  Appraisal(const StructuralSystem& system, const StiffnessSolver& solver, const RigidComplement& complement)
      : system_(system),
        solver_(solver),
        complement_(complement),
        mass_(system.mass),
        flexibility_(system.stiffness.flexibility) {}

  void operator()(Modes& modes, Index i, bool always_from_forces) {
    VectorXd shape = modes.shape.col(i), load = mass_ * shape;
    const double size = std::sqrt(shape.dot(load));
    shape /= size;
    load /= size;
    complement_.project_load(load);
    StiffnessSolver::Solution next = solver_.solve_with_forces(load);
    complement_.project_motion(next.coordinates);
    load = mass_ * next.coordinates;
    const double square =
        next.natural_forces.dot(flexibility_ * next.natural_forces) / next.coordinates.dot(load);
    const VectorXd difference = shape - square * next.coordinates;
    modes.residual[i] = std::sqrt(difference.dot(mass_ * difference));
    if (modes.residual[i] < converged) shape.swap(next.coordinates);
    orthonormalise(shape, modes.shape.leftCols(i));
    const double rayleigh = system_.stiffness.energy(shape);
    if (square < 0.0 || rayleigh < 0.0) throw_unstable(std::min(square, rayleigh));
    const bool from_forces = always_from_forces || modes.residual[i] < converged;
    modes.angular_frequency[i] = std::sqrt(from_forces ? square : rayleigh);
    modes.rayleigh_angular_frequency[i] = std::sqrt(rayleigh);
    modes.shape.col(i) = shape;
  }

 private:
  const StructuralSystem& system_;
  const StiffnessSolver& solver_;
  const RigidComplement& complement_;
  RepeatedRows mass_, flexibility_;

  // Against the modes below, which an inverse iteration brings out.
  void orthonormalise(VectorXd& shape, const Eigen::Ref<const MatrixXd>& below) const {
    const VectorXd load = mass_ * shape;
    if (below.cols() > 0) shape -= below * (below.transpose() * load).eval();
    shape /= std::sqrt(shape.dot(mass_ * shape));
  }
};

// Neighbours closer than the first estimates could tell may come in the wrong order.
void sort(Modes& modes) {
  std::vector<Index> order(static_cast<std::size_t>(modes.size()));
  std::iota(order.begin(), order.end(), Index{0});
  const auto ascending = [&](Index a, Index b) {
    return modes.angular_frequency[a] < modes.angular_frequency[b];
  };
  if (std::is_sorted(order.begin(), order.end(), ascending)) return;
  std::stable_sort(order.begin(), order.end(), ascending);
  modes.angular_frequency = modes.angular_frequency(order).eval();
  modes.rayleigh_angular_frequency = modes.rayleigh_angular_frequency(order).eval();
  modes.residual = modes.residual(order).eval();
  modes.shape = modes.shape(Eigen::all, order).eval();
}

}  // namespace

VectorXd Modes::frequency_hz() const {
  return angular_frequency / (2.0 * std::numbers::pi);
}

double Modes::digits(Index i) const {
  constexpr double most = 15.0;
  if (rayleigh_angular_frequency[i] == angular_frequency[i]) return most;
  return std::clamp(-std::log10(std::abs(rayleigh_angular_frequency[i] / angular_frequency[i] - 1.0)), 0.0,
                    most);
}

Modes modes(const StructuralSystem& system, Index count) {
  const Index n = system.size();
  if (count < 1 || count > n)
    throw std::invalid_argument("modes: count is " + std::to_string(count) + "; expected 1 to " +
                                std::to_string(n));
  const StiffnessSolver solver(system.stiffness);
  const RigidComplement complement(system.mass, solver.rigid_motions());
  const Index rigid = std::min(count, complement.count()), flexible = count - rigid;
  const bool few = 3 * count < n && n > 60;

  Modes result;
  result.rigid = rigid;
  result.angular_frequency = result.rayleigh_angular_frequency = result.residual = VectorXd::Zero(count);
  if (flexible > 0) {
    result.shape =
        few ? lowest_shapes(system, solver, complement, flexible) : all_shapes(system, solver, complement);
    if (result.shape.cols() < flexible)
      throw std::runtime_error("modes: only " + std::to_string(rigid + result.shape.cols()) + " of the " +
                               std::to_string(count) + " modes requested have mass");
  }
  if (rigid > 0 || result.shape.cols() > flexible) {
    MatrixXd shapes(n, count);
    shapes.leftCols(rigid) = complement.modes().leftCols(rigid);
    if (flexible > 0) shapes.rightCols(flexible) = result.shape.leftCols(flexible);
    result.shape.swap(shapes);
  }

  Appraisal appraise(system, solver, complement);
  for (Index i = rigid; i < count; ++i) {
    appraise(result, i, few);
    if (few && !(result.residual[i] < largest_residual)) {  // what Lanczos calls converged need not be a mode
      std::ostringstream message;
      const bool compressed = system.stiffness.rigidity.diagonal().minCoeff() < 0.0;
      message << "modes: mode " << i + 1 << " has a relative residual of " << result.residual[i] << "; "
              << (compressed ? "the axial load is too close to a buckling load"
                             : "masses or stiffnesses are too far apart")
              << " for double precision";
      throw std::runtime_error(message.str());
    }
  }
  sort(result);
  return result;
}

namespace {

/// [F, M phi; (M phi)^T, 0].
SparseMatrix bordered(const SparseMatrix& inner, const VectorXd& border) {
  const Index n = inner.rows();
  std::vector<Eigen::Triplet<double>> entries;
  for (Index column = 0; column < inner.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(inner, column); entry; ++entry)
      entries.emplace_back(entry.row(), entry.col(), entry.value());
  for (Index i = 0; i < n; ++i) {
    entries.emplace_back(i, n, border[i]);
    entries.emplace_back(n, i, border[i]);
  }
  SparseMatrix result(n + 1, n + 1);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// K_j phi and M_j phi of all parameters, which every mode needs.
struct ParameterMatrices {
  std::vector<SparseMatrix> stiffness, mass;  ///< q
};

ModeCurve curve_of(const ParametricSystem& equations, const ParameterMatrices& by,
                   const SparseMatrix& stiffness, double square, const VectorXd& shape) {
  const SparseMatrix &mass = equations.system.mass, &outputs = equations.system.outputs;
  const Index n = shape.size(), q = equations.values.size(), p = outputs.rows();
  const VectorXd momentum = mass * shape;
  // Both parts of a size: the border as large as F is.
  const double scale = square * momentum.norm() / momentum.squaredNorm();
  Eigen::SparseLU<SparseMatrix> solver;
  solver.compute(bordered(stiffness - square * mass, scale * momentum));
  if (solver.info() != Eigen::Success)
    throw std::runtime_error("a mode at omega^2 = " + std::to_string(square) +
                             " shares its frequency with another: its shape has no derivative");
  const auto solve = [&](const VectorXd& force, double along) -> VectorXd {
    VectorXd right(n + 1);
    right << force, scale * along;
    return solver.solve(right).head(n);
  };

  ModeCurve curve{square,         VectorXd(q),
                  MatrixXd(q, q), outputs * shape,
                  MatrixXd(p, q), std::vector<MatrixXd>(static_cast<std::size_t>(p), MatrixXd(q, q))};
  MatrixXd stiff(n, q), heavy(n, q), shapes(n, q);  // K_j phi, M_j phi, phi_j
  for (Index j = 0; j < q; ++j) {
    stiff.col(j) = by.stiffness[static_cast<std::size_t>(j)] * shape;
    heavy.col(j) = by.mass[static_cast<std::size_t>(j)] * shape;
    curve.square_slope[j] = shape.dot(stiff.col(j) - square * heavy.col(j));
    const VectorXd turned = stiff.col(j) - square * heavy.col(j) - curve.square_slope[j] * momentum;
    shapes.col(j) = solve(-turned, -0.5 * shape.dot(heavy.col(j)));
  }
  curve.reading_slope = outputs * shapes;

  const VectorXd& slope = curve.square_slope;
  const auto turn = [&](Index j, const VectorXd& on) -> VectorXd {  // F_j on a shape
    return by.stiffness[static_cast<std::size_t>(j)] * on -
           square * (by.mass[static_cast<std::size_t>(j)] * on) - slope[j] * (mass * on);
  };
  for (Index j = 0; j < q; ++j)
    for (Index l = 0; l <= j; ++l) {
      const double bend =
          2.0 * shapes.col(l).dot(stiff.col(j) - square * heavy.col(j)) - slope[l] * shape.dot(heavy.col(j));
      const VectorXd force = turn(j, shapes.col(l)) + turn(l, shapes.col(j)) - bend * momentum -
                             slope[j] * heavy.col(l) - slope[l] * heavy.col(j);
      const double along = -shapes.col(l).dot(mass * shapes.col(j)) - heavy.col(l).dot(shapes.col(j)) -
                           heavy.col(j).dot(shapes.col(l));
      const VectorXd reading = outputs * solve(-force, along);
      curve.square_curvature(j, l) = curve.square_curvature(l, j) = bend;
      for (Index i = 0; i < p; ++i) {
        MatrixXd& curvature = curve.reading_curvature[static_cast<std::size_t>(i)];
        curvature(j, l) = curvature(l, j) = reading[i];
      }
    }
  return curve;
}

}  // namespace

std::vector<ModeCurve> mode_curves(const ParametricSystem& equations, const Modes& modes) {
  if (modes.rigid > 0)
    throw std::invalid_argument(std::to_string(modes.rigid) +
                                " rigid modes; expected a structure that is held");
  ParameterMatrices by;
  for (std::size_t j = 0; j < equations.derivatives.size(); ++j) {
    by.stiffness.push_back(equations.stiffness_derivative(j));
    by.mass.push_back(equations.derivatives[j].mass);
  }
  const SparseMatrix stiffness = equations.system.stiffness.assembled();
  std::vector<ModeCurve> curves;
  for (Index i = 0; i < modes.size(); ++i) {
    const double omega = modes.angular_frequency[i];
    curves.push_back(curve_of(equations, by, stiffness, omega * omega, modes.shape.col(i)));
  }
  return curves;
}

double lowest_frequency_hz(const StructuralSystem& system) {
  constexpr Index most_rigid = 6;  // of a structure in space
  for (Index count = 1; count <= std::min(most_rigid + 1, system.size()); ++count) {
    const Modes lowest = modes(system, count);
    if (lowest.rigid < count) return lowest.frequency_hz()[lowest.rigid];
  }
  return 0.0;
}

}  // namespace beamid::fem
