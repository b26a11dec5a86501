#include "fem/solvers/rigid_complement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "fem/stiffness_solver.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

RepeatedRows::RepeatedRows(const Eigen::SparseMatrix<double>& symmetric) {
  kind_.reserve(static_cast<std::size_t>(symmetric.rows()));
  std::vector<Entry> row;
  for (int k = 0; k < symmetric.outerSize(); ++k) {
    row.clear();
    for (Eigen::SparseMatrix<double>::InnerIterator it(symmetric, k); it; ++it)
      row.push_back({static_cast<int>(it.row()) - k, it.value()});
    add(row);
  }
}

void RepeatedRows::add(const std::vector<Entry>& row) {
  constexpr std::size_t memory = 8;  // a mesh repeats after two or three rows
  const std::size_t kinds = first_.size() - 1;
  const auto same = [](const Entry& a, const Entry& b) { return a.offset == b.offset && a.value == b.value; };
  for (std::size_t kind = kinds; kind > 0 && kind + memory > kinds; --kind)
    if (std::equal(row.begin(), row.end(), entries_.begin() + first_[kind - 1],
                   entries_.begin() + first_[kind], same)) {
      kind_.push_back(static_cast<std::uint32_t>(kind - 1));
      return;
    }
  kind_.push_back(static_cast<std::uint32_t>(kinds));
  entries_.insert(entries_.end(), row.begin(), row.end());
  first_.push_back(static_cast<std::uint32_t>(entries_.size()));
}

RigidComplement::RigidComplement(const SparseMatrix& mass, Eigen::MatrixXd motions)
    : modes_(std::move(motions)) {
  if (count() == 0) return;
  // Twice: the first leaves what rounding costs a basis that is far from orthogonal.
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::LLT<Eigen::MatrixXd> gram(modes_.transpose() * (mass * modes_));
    if (gram.info() != Eigen::Success)
      throw std::runtime_error("modes: a rigid-body motion of the structure has no mass");
    gram.matrixU().solveInPlace<Eigen::OnTheRight>(modes_);
  }
  loads_ = mass * modes_;
}

namespace {

// The vectors that Lanczos builds.

/// Orthonormal vectors, V^T M V = I, of the Krylov space of K^-1 M, and the tridiagonal T = V^T M K^-1 M V
/// [parlett1998, ch. 13]. It starts from a random motion that K^-1 M has made smooth and rid of what has no
/// mass. Each vector is made orthogonal to the two before it, which is all that exact arithmetic asks for,
/// and then to all of them.
class KrylovBasis {
 public:
  /// @param seed of the motion it starts from.
  KrylovBasis(const StructuralSystem& system, const StiffnessSolver& solver,
              const RigidComplement& complement, std::uint64_t seed = 1);

  /// Appends a vector. @returns false when there is none left: the space is invariant.
  bool grow();

  Eigen::Index steps() const { return static_cast<Eigen::Index>(diagonal_.size()); }
  Eigen::VectorXd diagonal() const;         ///< of T (steps)
  Eigen::VectorXd beside_diagonal() const;  ///< of T (steps - 1)

  /// Norm of what the next vector was before it was normalised, the coupling of the space to the rest.
  double coupling() const { return coupling_; }

  /// V y for the columns of y (steps x k).
  Eigen::MatrixXd combine(const Eigen::MatrixXd& y) const;

 private:
  const StiffnessSolver& solver_;
  const RigidComplement& complement_;
  RepeatedRows mass_;
  std::vector<Eigen::MatrixXd> blocks_;  // of V, so many columns each: V grows without being copied
  std::vector<double> diagonal_, beside_;
  double coupling_ = 0.0;
  Eigen::VectorXd next_, load_, work_, natural_forces_;  // next vector of V and M times it

  Eigen::Ref<Eigen::VectorXd> column(Eigen::Index i);
  void apply_inverse();  // work = K^-1 load, without rigid motion
  void orthogonalise();  // work against V, given load = M work
  double norm() const;   // of work, given load = M work
};

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index block_columns = 8;
constexpr Index chunk = 2048;      // rows; their part of a vector stays in the nearest cache
constexpr double nothing = 1e-18;  // left of a vector, relative to the largest Ritz value so far

KrylovBasis::KrylovBasis(const StructuralSystem& system, const StiffnessSolver& solver,
                         const RigidComplement& complement, std::uint64_t seed)
    : solver_(solver),
      complement_(complement),
      mass_(system.mass),
      next_(system.size()),
      work_(system.size()),
      natural_forces_(VectorXd::Zero(system.stiffness.strain.rows())) {
  std::mt19937_64 random(seed);
  for (double& value : next_) value = 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0;
  load_ = mass_ * next_;
  apply_inverse();
  next_ = work_;
  load_ = mass_ * next_;
  const double norm = std::sqrt(next_.dot(load_));
  next_ /= norm;
  load_ /= norm;
}

Eigen::Ref<VectorXd> KrylovBasis::column(Index i) {
  if (i / block_columns == static_cast<Index>(blocks_.size()))
    blocks_.emplace_back(next_.size(), block_columns);
  return blocks_[i / block_columns].col(i % block_columns);
}

void KrylovBasis::apply_inverse() {
  complement_.project_load(load_);
  solver_.solve_into(load_, work_, natural_forces_);
  complement_.project_motion(work_);
}

bool KrylovBasis::grow() {
  const Index step = steps();
  if (step > 0) beside_.push_back(coupling_);
  column(step) = next_;
  apply_inverse();
  diagonal_.push_back(work_.dot(load_));
  work_ -= diagonal_.back() * next_;
  if (step > 0) work_ -= beside_.back() * column(step - 1);
  mass_.multiply(work_.data(), load_.data());
  double before = std::numeric_limits<double>::infinity();
  coupling_ = norm();
  for (int pass = 0; pass < 3 && coupling_ < 0.5 * before; ++pass) {  // once, as a rule; twice is enough
    before = coupling_;
    orthogonalise();
    mass_.multiply(work_.data(), load_.data());
    coupling_ = norm();
  }
  const double largest = std::abs(*std::max_element(
      diagonal_.begin(), diagonal_.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  if (!(coupling_ > nothing * largest)) {
    coupling_ = 0.0;
    return false;
  }
  next_ = work_ / coupling_;
  load_ /= coupling_;
  return true;
}

double KrylovBasis::norm() const {
  return std::sqrt(std::max(0.0, work_.dot(load_)));
}

void KrylovBasis::orthogonalise() {
  VectorXd overlap(steps());
  for (Index first = 0; first < steps(); first += block_columns) {
    const Index columns = std::min(block_columns, steps() - first);
    overlap.segment(first, columns).noalias() =
        blocks_[first / block_columns].leftCols(columns).transpose() * load_;
  }
  for (Index row = 0; row < work_.size(); row += chunk) {
    const Index rows = std::min(chunk, work_.size() - row);
    for (Index first = 0; first < steps(); first += block_columns) {
      const Index columns = std::min(block_columns, steps() - first);
      work_.segment(row, rows).noalias() -=
          blocks_[first / block_columns].block(row, 0, rows, columns) * overlap.segment(first, columns);
    }
  }
}

VectorXd KrylovBasis::diagonal() const {
  return Eigen::Map<const VectorXd>(diagonal_.data(), steps());
}

VectorXd KrylovBasis::beside_diagonal() const {
  return Eigen::Map<const VectorXd>(beside_.data(), static_cast<Index>(beside_.size()));
}

MatrixXd KrylovBasis::combine(const MatrixXd& y) const {
  MatrixXd result = MatrixXd::Zero(next_.size(), y.cols());
  for (Index first = 0; first < steps(); first += block_columns) {
    const Index columns = std::min(block_columns, steps() - first);
    result.noalias() += blocks_[first / block_columns].leftCols(columns) * y.middleRows(first, columns);
  }
  return result;
}

constexpr double tolerance =
    1e-10;  // of a Ritz pair, relative; one more inverse iteration follows (modes.cpp)
constexpr double rounding = 1e-12;   // of a Ritz value, relative to the largest
constexpr double same_theta = 1e-7;  // what is no larger than this, relative, is not missed
constexpr double settled = 1e-3;     // error of a Ritz pair, relative, before it says what is largest
constexpr Index steps_for_stability = 40;

using RitzPairs = Eigen::SelfAdjointEigenSolver<MatrixXd>;

RitzPairs ritz_pairs(const KrylovBasis& basis) {
  RitzPairs pairs;
  pairs.computeFromTridiagonal(basis.diagonal(), basis.beside_diagonal());
  return pairs;
}

// Shapes (n x k) and theta = 1/omega^2 (k), descending.
struct Found {
  MatrixXd shapes;
  VectorXd theta;
};

// How far the Ritz pairs may be from eigenpairs; the largest come last.
Eigen::ArrayXd errors(const RitzPairs& pairs, const KrylovBasis& basis) {
  return basis.coupling() * pairs.eigenvectors().bottomRows(1).transpose().array().abs();
}

bool have_converged(const RitzPairs& pairs, const KrylovBasis& basis, Index count) {
  const auto theta = pairs.eigenvalues().tail(count).array();
  return (theta > 0.0).all() && (errors(pairs, basis).tail(count) < tolerance * theta).all();
}

// The `count` largest theta converge together with their vectors.
Found find_lowest(const StructuralSystem& system, const StiffnessSolver& solver,
                  const RigidComplement& complement, Index count) {
  const bool may_buckle = system.stiffness.rigidity.diagonal().minCoeff() < 0.0;
  const Index most = std::min(system.size() - complement.count(), 20 * count + 200);
  KrylovBasis basis(system, solver, complement);
  Index next_look = std::min(most, std::max<Index>(count + 3, may_buckle ? steps_for_stability : 0));
  for (bool more = true; more;) {
    more = basis.grow() && basis.steps() < most;
    if (more && basis.steps() < next_look) continue;
    next_look = basis.steps() + 1 + basis.steps() / 20;
    if (basis.steps() < count) break;
    const RitzPairs pairs = ritz_pairs(basis);
    const VectorXd& theta = pairs.eigenvalues();
    if (theta[0] < -rounding * theta.cwiseAbs().maxCoeff()) throw_unstable(1.0 / theta[0]);
    if (have_converged(pairs, basis, count))
      return {basis.combine(pairs.eigenvectors().rightCols(count).rowwise().reverse()),
              theta.tail(count).reverse()};
  }
  throw std::runtime_error("modes: " + std::to_string(count) + " modes have not converged within " +
                           std::to_string(basis.steps()) +
                           " Lanczos steps; masses or stiffnesses are too far apart for double precision");
}

// What has a larger theta than the last one found and was not seen; no columns when there is nothing.
Found find_missed(const StructuralSystem& system, const StiffnessSolver& solver,
                  const RigidComplement& complement, const Found& found, std::uint64_t seed) {
  MatrixXd known(system.size(), complement.count() + found.shapes.cols());
  known << complement.modes(), found.shapes;
  const RigidComplement rest(system.mass, std::move(known));
  const double limit = found.theta[found.theta.size() - 1] * (1.0 + same_theta);
  const Index most = std::min(system.size() - rest.count(), 20 * found.theta.size() + 200);
  if (most < 1) return {};
  KrylovBasis basis(system, solver, rest, seed);
  for (bool more = true; more;) {
    more = basis.grow() && basis.steps() < most;
    const RitzPairs pairs = ritz_pairs(basis);
    const double largest = pairs.eigenvalues()[basis.steps() - 1],
                 error = errors(pairs, basis)[basis.steps() - 1];
    if (error <= settled * std::abs(largest) && largest + error <= limit) return {};
    if (largest > limit && have_converged(pairs, basis, 1))
      return {basis.combine(pairs.eigenvectors().rightCols(1)), pairs.eigenvalues().tail(1)};
  }
  throw std::runtime_error("modes: no proof within " + std::to_string(basis.steps()) +
                           " Lanczos steps that no mode was missed");
}

// Takes the place of the last one whose theta is smaller.
void take_in(Found& found, const Found& missed) {
  Index i = found.theta.size() - 1;
  for (; i > 0 && found.theta[i - 1] < missed.theta[0]; --i) {
    found.theta[i] = found.theta[i - 1];
    found.shapes.col(i) = found.shapes.col(i - 1);
  }
  found.theta[i] = missed.theta[0];
  found.shapes.col(i) = missed.shapes.col(0);
}

}  // namespace

void throw_unstable(double square) {
  std::ostringstream message;
  message << "the structure is unstable: a mode has omega^2 = " << square
          << " rad^2/s^2; an axial load beyond buckling does this";
  throw std::runtime_error(message.str());
}

MatrixXd lowest_shapes(const StructuralSystem& system, const StiffnessSolver& solver,
                       const RigidComplement& complement, Index count) {
  Found found = find_lowest(system, solver, complement, count);
  constexpr std::uint64_t first_seed = 1;
  for (std::uint64_t seed = first_seed + 1;; ++seed) {
    const Found missed = find_missed(system, solver, complement, found, seed);
    if (missed.theta.size() == 0) return std::move(found.shapes);
    take_in(found, missed);
  }
}

}  // namespace beamid::fem
