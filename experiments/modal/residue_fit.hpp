// Residues, residual terms and refined poles of frequency responses.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

namespace beamid::experiments {

// What the noise of a record leaves of parameters that were fitted to lines of its spectrum.

/// Noise d_k at lines f_k of a record of length T under an exponential window e^(-a t):
///
///     d_k = s_k / |w| sum_n w_n e_n e^(-i 2 pi f_k t_n),   e_n white,   so   E |d_k|^2 = s_k^2
///
/// The window makes neighbouring lines dependent, over about a T of them.
struct LineNoise {
  double decay = 0;      ///< a T
  Eigen::VectorXd size;  ///< (F) s_k but for a factor; empty: the same at all lines
};

/// Covariance (n x n) of least squares x = (J^T J)^-1 J^T (y + d) with real x and complex y (p x F):
///
///     x - E x = sum_n w_n / |w| e_n g(t_n),   g(t) = Re sum_k s_k a_k e^(i 2 pi f_k t),   a = J (J^T J)^-1
///
/// and the sum over n of w_n^2 / |w|^2 g g^T. The noise of each output is found from what the fit leaves,
/// line by line over the lines around with eight degrees of freedom, over what it leaves of such noise by
/// expectation, tr((I - P) C (I - P)): a fit takes the more, the fewer lines a peak has. The deviation is
/// that of Student's t with the degrees of freedom; NaN where there are two or less.
/// @param frequency_hz (F) multiples of 1 / T, next to each other
/// @param jacobian (2 p F x n) J, for each output the real parts of all lines, then the imaginary ones
/// @param inverse (n x n) (J^T J)^-1
/// @param left (2 p F) residual
/// @param explained (2 p F) mean square of what else is in it: taken off, down to a tenth
Eigen::MatrixXd covariance_under(const LineNoise& noise, const Eigen::VectorXd& frequency_hz,
                                 const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& inverse,
                                 const Eigen::VectorXd& left, const Eigen::VectorXd& explained);

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
/// that of noise as large as the residual is around each line (residue_fit.hpp) and of the force's errors.
/// @throws std::runtime_error when it does not converge.
ResidueFit refine_poles(const Eigen::VectorXd& frequency_hz, const Eigen::MatrixXcd& responses, double shift,
                        int power, const std::vector<std::complex<double>>& rates,
                        const ResponseNoise& noise = {});

}  // namespace beamid::experiments
