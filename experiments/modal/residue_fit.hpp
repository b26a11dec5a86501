// Residues, residual terms and refined poles of frequency responses.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "experiments/modal/line_noise.hpp"

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

/// What is wrong with frequency responses at F lines.
struct ResponseNoise {
  LineNoise lines;
  /// (F x q) relative errors of the force, independent, a standard deviation each: H is off by -H of them. Of
  /// aliases the response has its own, (H_inf - H) of them with H_inf what H tends to at high frequencies.
  Eigen::MatrixXcd force, aliases;
};

/// Linear least squares over lines s = i 2 pi f + shift (F) with the poles given.
ResidueFit fit_residues(const Eigen::VectorXd& frequency_hz, const Eigen::MatrixXcd& responses, double shift,
                        int power, const std::vector<std::complex<double>>& rates);

/// The same with the poles refined by Gauss-Newton steps, damped where they do not descend. The covariance is
/// that of noise as large as the residual is around each line (line_noise.hpp) and of the force's errors.
/// @throws std::runtime_error when it does not converge.
ResidueFit refine_poles(const Eigen::VectorXd& frequency_hz, const Eigen::MatrixXcd& responses, double shift,
                        int power, const std::vector<std::complex<double>>& rates,
                        const ResponseNoise& noise = {});

}  // namespace beamid::experiments
