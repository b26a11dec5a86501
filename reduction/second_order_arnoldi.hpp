// Krylov spaces of systems of second order.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::reduction {

/// Vectors Q (n x r), Q^H M Q = I, that span
///
///     r_0 = b,    r_1 = A b,    r_j = A r_j-1 + B r_j-2
///
/// for every column b of `starts` (n x m): `count` independent ones per column, fewer where there are no
/// more. The recursion itself would soon repeat the strongest motion only. Here pairs (q, p) are kept, p
/// being what would come before q, and both are combined as q is made orthogonal [bai2005]. Where nothing is
/// left of q (every second time when A = 0) its p goes on alone.
///
/// @param a, b  functions that give A q and B q (n) of q (n).
template <class Scalar, class A, class B>
Eigen::MatrixX<Scalar> second_order_arnoldi(const fem::SparseMatrix& mass, const A& a, const B& b,
                                            const Eigen::MatrixX<Scalar>& starts, Eigen::Index count) {
  using Vector = Eigen::VectorX<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;
  constexpr double dependent = 1e-11;  // of a vector's own length
  constexpr int tries = 3;             // vectors in a row that may bring nothing
  struct Chain {
    Vector q, p;
    Eigen::Index found = 0;
    int in_vain = 0;
  };
  Matrix basis(mass.rows(), 0), before(mass.rows(), 0);
  const auto norm = [&](const Vector& v) {
    return std::sqrt(std::max(0.0, std::real(v.dot(Vector(mass.template cast<Scalar>() * v)))));
  };
  // Appends what r adds to the basis, s going along with it, and lets the chain continue from there.
  const auto take = [&](Chain& chain, Vector r, Vector s) {
    const double length = norm(r);
    double left = 0.0;
    if (length > 0.0 && basis.cols() < mass.rows()) {
      for (int pass = 0; pass < 3; ++pass) {
        const Vector along = basis.adjoint() * (mass.template cast<Scalar>() * r);
        r -= basis * along;
        s -= before * along;
      }
      left = norm(r);
    }
    const bool is_new = left > dependent * length;
    if (is_new) {
      chain.q = r / left;
      chain.p = s / left;
      basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
      before.conservativeResize(Eigen::NoChange, basis.cols());
      basis.rightCols(1) = chain.q;
      before.rightCols(1) = chain.p;
      ++chain.found;
      chain.in_vain = 0;
    } else {
      chain.q = Vector::Zero(mass.rows());
      chain.p = s;
      ++chain.in_vain;
    }
  };

  std::vector<Chain> chains(static_cast<std::size_t>(starts.cols()));
  for (Eigen::Index i = 0; i < starts.cols(); ++i) take(chains[i], starts.col(i), Vector::Zero(mass.rows()));
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (Chain& chain : chains) {
      if (chain.found >= count || chain.in_vain >= tries) continue;
      goes_on = true;
      take(chain, a(chain.q) + b(chain.p), chain.q);
    }
  }
  return basis;
}

}  // namespace beamid::reduction
