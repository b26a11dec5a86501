#include "fem/solvers/krylov_basis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index block_columns = 8;
constexpr Index chunk = 2048;      // rows; their part of a vector stays in the nearest cache
constexpr double nothing = 1e-18;  // left of a vector, relative to the largest Ritz value so far

}  // namespace

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

}  // namespace beamid::fem
