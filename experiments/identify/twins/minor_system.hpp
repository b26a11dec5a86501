// Polynomials in which each unknown is linear: the principal minors of diag(k) A, summed by their order.
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <vector>

#include "experiments/identify/twins/spectrum_solutions.hpp"

namespace beamid::experiments {

using PathComplex = std::complex<double>;
using ComplexVector = Eigen::Matrix<PathComplex, Eigen::Dynamic, 1, 0, most_paths_order, 1>;
using ComplexMatrix =
    Eigen::Matrix<PathComplex, Eigen::Dynamic, Eigen::Dynamic, 0, most_paths_order, most_paths_order>;

/// F_r(u; tau) = sum_{|S| = r} w_S(tau) exp(sum_{i in S} u_i) / c_r - 1,  r = 1 ... n,
///
/// with w_S(tau) = 1 + tau (det A_S - 1), c_r = e_r(lambda), u = ln k; A has a unit diagonal. At tau = 0 the
/// solutions are the permutations of ln lambda, at tau = 1 they are those wanted.
class MinorSystem {
 public:
  MinorSystem(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& spectrum);

  Eigen::Index size() const { return n_; }

  struct Value {
    ComplexVector residual;                                                 ///< F (n)
    ComplexMatrix jacobian;                                                 ///< dF/du (n x n)
    ComplexVector motion;                                                   ///< dF/dtau (n)
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_paths_order, 1> size;  ///< T_r, F's terms in modulus (n)
  };
  void at(const ComplexVector& u, PathComplex tau, Value& value) const;

 private:
  Eigen::Index n_;
  std::vector<double> minor_;  // det A_S of every subset S of 1 ... n, as bits
  std::vector<int> order_;     // |S|
  Eigen::VectorXd sums_;       // e_r(lambda)
};

}  // namespace beamid::experiments
