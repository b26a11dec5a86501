#include "fem/solvers/lanczos.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "fem/solvers/krylov_basis.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
