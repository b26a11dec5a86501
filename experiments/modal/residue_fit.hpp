// Residues, residual terms and refined poles of frequency responses.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace beamid::experiments {

/// H_o(s) = s^k (sum_m R_om / (s - p_m) + conj(R_om) / (s - conj(p_m)) + U_o + L_o / s^2), with k = 0, 1, 2
/// for displacement, velocity and acceleration per force. U is the flexibility of the modes above the band, L
/// the mobility of the mass of those below [ewins2000, ch. 4].
struct ResidueFit {
  std::vector<std::complex<double>> rates;  ///< K, p_m [rad/s]
  Eigen::MatrixXcd residues;                ///< (p x K), R [unit of displacement / (N s)]
  Eigen::VectorXd upper, lower;             ///< (p), U [m/N] and L [1/kg]
  Eigen::MatrixXcd reproduced;              ///< (p x F)
  /// (n x n) of Im p_1, -Re p_1, Im p_2, ..., then for each output Re R_1, Im R_1, ..., U, L; empty before
  /// refine_poles().
  Eigen::MatrixXd covariance;
};

/// Linear least squares over lines s = i 2 pi f + shift (F) with the poles given.
ResidueFit fit_residues(const Eigen::VectorXd& frequency_hz, const Eigen::MatrixXcd& responses, double shift,
                        int power, const std::vector<std::complex<double>>& rates);

/// The same with the poles refined by Gauss-Newton steps, damped where they do not descend. The covariance is
/// that of residuals of unequal size, (J^T J)^-1 J^T diag(r^2) J (J^T J)^-1 [white1980].
/// @param correlated lines over which the window spreads noise, 1 or more: multiplies the covariance
/// @throws std::runtime_error when it does not converge.
ResidueFit refine_poles(const Eigen::VectorXd& frequency_hz, const Eigen::MatrixXcd& responses, double shift,
                        int power, const std::vector<std::complex<double>>& rates, double correlated = 1);

}  // namespace beamid::experiments
