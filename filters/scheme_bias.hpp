// The bias of a discretisation with many degrees of freedom (docs/theory/many_degrees_of_freedom.md).
//
//     M x'' + C x' + K x = 0,    z' = A z,  z = [x; x'],    A = [0, I; -M^-1 K, -M^-1 C]
//
// Displacements of all n coordinates are observed every dt, without process noise. A one-step scheme of
// stability function g moves by g(A_f dt). It reproduces the record where
//
//     g(A_f dt) = e^(A dt),    A_f = g^-1(e^(A dt)) / dt
//
// Its first n rows need not be [0, I]: what is observed is x alone, so that the rates of the scheme's state
// are free. With T = [I, 0; first n rows of A_f] the matrix T A_f T^-1 has the form of A, and its last n rows
// are -M^-1 K_f and -M^-1 C_f. Both matrices are unique.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "filters/scheme.hpp"

namespace beamid::filters {

/// A_f (m x m) of any matrix A (m x m), by Newton's method in matrices: no eigenvectors are needed, so that
/// equal and defective eigenvalues are no exception. Each eigenvalue is on the branch of the scalar function.
/// @throws std::runtime_error when it does not converge (dt too large for the scheme).
Eigen::MatrixXd seen_through(Scheme& scheme, const Eigen::MatrixXd& matrix, double dt);

/// g(Z), by the steps of the scheme itself.
Eigen::MatrixXd amplification(Scheme& scheme, const Eigen::MatrixXd& z);
/// Its derivative along a direction of Z, lim (g(Z + h D) - g(Z)) / h.
Eigen::MatrixXd amplification_slope(Scheme& scheme, const Eigen::MatrixXd& z,
                                    const Eigen::MatrixXd& direction);

/// The coefficients a_1 .. a_count (those of z^1 ... z^count) of
///
///     lambda_f = lambda (1 + a_1 z + a_2 z^2 + ...),    z = lambda dt
///
/// The first that is not zero is a_p, p the order of the scheme; smaller ones than 1e-10 are set to zero.
/// Forward Euler: 1/2, 1/6, 1/24, ...; backward Euler: -1/2, 1/6, -1/24, ...
std::vector<double> bias_series(const Scheme& scheme, int count);

/// M x'' + C x' + K x = 0 (n x n each); M symmetric and positive, K and C any.
struct SecondOrder {
  Eigen::MatrixXd mass, damping, stiffness;

  Eigen::Index size() const { return mass.rows(); }
  /// A (2n x 2n)
  Eigen::MatrixXd motion_matrix() const;
};

/// K_f and C_f that a filter finds which moves by the scheme, whatever the damping. @throws as above, and
/// where no equation of second order has the scheme's displacements.
SecondOrder seen_through(Scheme& scheme, const SecondOrder& truth, double dt);

/// K and C behind K_f and C_f: A = log(g(A_f dt)) / dt. The inverse of seen_through(): the cure of a
/// published estimate, exact where the model could represent K_f and C_f.
SecondOrder behind(Scheme& scheme, const SecondOrder& found, double dt);

/// The terms of K_f - K and C_f - C that are linear in the coefficients a_p ... a_(2p-1). With S = M^-1 K,
/// D = M^-1 C and A^k = [.., ..; P_k, Q_k] read as x^(k) = P_k x + Q_k x',
///
///     M^-1 (K_f - K) = - sum_k a_k dt^k (2 P_(k+2) + D P_(k+1))
///     M^-1 (C_f - C) = - sum_k a_k dt^k (2 Q_(k+2) + D Q_(k+1))
///     P_0 = I, Q_0 = 0,   P_(k+1) = -Q_k S,   Q_(k+1) = P_k - Q_k D
///
/// Forward Euler: C_f = C + dt K - dt/2 C M^-1 C,  K_f = K - dt/2 C M^-1 K. The remainder is of order dt^2p.
struct BiasTerms {
  int order = 0;  ///< p; 0: of a scheme without bias
  Eigen::MatrixXd damping, stiffness;
};
BiasTerms first_terms(const Scheme& scheme, const SecondOrder& truth, double dt);

}  // namespace beamid::filters
