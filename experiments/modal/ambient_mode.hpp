// One mode of a structure under loads that nobody measured, from the Fourier transforms of its channels.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace beamid::experiments {

/// What the response's spectrum is of a force of flat spectrum.
enum class ResponseKind { displacement, velocity, acceleration };

/// D(b) = b^(2 q) / ((b^2 - 1)^2 + (2 zeta b)^2), b = f / f_0: that spectrum of a mode, q = 0, 1, 2 of a
/// displacement, a velocity, an acceleration.
double response_to_force(double b, double damping_ratio, ResponseKind kind);

/// Fourier coefficients of a band, F_k = sqrt(2 dt / N) sum_j y_j e^(-i 2 pi f_k t_j) for p channels, of the
/// N first samples that transform fast.
struct BandCoefficients {
  Eigen::VectorXd frequency_hz;   ///< f_k (n)
  Eigen::MatrixXcd coefficients;  ///< (p x n)
};
/// The whole spectrum of a record (p x N), means removed; bands of it by within().
BandCoefficients fourier_coefficients(const Eigen::MatrixXd& outputs, double interval);
BandCoefficients within(const BandCoefficients& all, const std::pair<double, double>& band_hz);
/// All but f_k and its two neighbours, over which a line between two of them spreads.
BandCoefficients without(const BandCoefficients& all, double frequency_hz);

/// The likeliest mode of a band and its deviations.
struct AmbientMode {
  double frequency_hz = 0.0, damping_ratio = 0.0;
  double force_density = 0.0;  ///< S, of the modal force over the modal mass [unit^2/Hz]
  double noise_density = 0.0;  ///< S_e [unit^2/Hz]
  Eigen::VectorXd shape;       ///< of unit length (p)
  double frequency_deviation_hz = 0.0, damping_ratio_deviation = 0.0;
  bool converged = false;
  std::pair<double, double> band_hz;  ///< that it was found in
};

/// Bayes' fast Fourier method for one mode in a band [au2011]: F_k are independent complex Gaussian numbers
/// of the covariance S D_k phi phi^T + S_e 1, D_k = b^(2 q) / ((b^2 - 1)^2 + (2 zeta b)^2), b = f / f_0, with
/// q = 0, 1, 2 of a displacement, a velocity, an acceleration. With phi the first eigenvector of A = sum_k
/// Re(F_k F_k^H) S D_k / (S D_k + S_e),
///
///     -ln p = (p - 1) n ln S_e + sum_k ln(S D_k + S_e) + (sum_k |F_k|^2 - lambda_1(A)) / S_e,
///
/// whose least value and curvature are estimate and covariance.
/// @throws std::invalid_argument when the band has fewer than 8 coefficients.
AmbientMode ambient_mode(const BandCoefficients& band, double frequency_hz, double damping_ratio,
                         ResponseKind kind);

/// How far from the mode a band is at each f_k, F_k^H (S D_k phi phi^T + S_e 1)^-1 F_k (n): of a right model
/// the sum of p exponentially distributed numbers of mean 1.
Eigen::VectorXd band_misfit(const AmbientMode& mode, const BandCoefficients& band, ResponseKind kind);

/// What no unbiased estimate of a long record falls below, relative to f and zeta [au2014]: N_c periods, a
/// band of f (1 +- kappa zeta), a response far above the noise.
struct AmbientLaw {
  double frequency = 0.0;  ///< sqrt(zeta / (2 pi N_c B_f))
  double damping = 0.0;    ///< 1 / sqrt(2 pi zeta N_c B_z)
};
AmbientLaw ambient_law(double damping_ratio, double periods, double kappa);

}  // namespace beamid::experiments
