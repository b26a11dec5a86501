// Two close modes of a structure under loads that nobody measured, from one band of the Fourier transforms.
#pragma once

#include <array>

#include "experiments/modal/ambient_mode.hpp"

namespace beamid::experiments {

/// Two modes in one band, and how much better they explain it than one.
struct AmbientPair {
  std::array<AmbientMode, 2> modes;  ///< by rising frequency
  double gain = 0.0;                 ///< 2 (ln p of two modes - ln p of the one given), of the likelihood
  int more_parameters = 0;           ///< than those of one mode
  Eigen::VectorXd misfit;            ///< F_k^H E_k^-1 F_k (n), as band_misfit() has it of one mode
  double coherence = 0.0;            ///< |S_12| / sqrt(S_11 S_22) of their forces
  bool converged = false;
};

/// Bayes' fast Fourier method for two modes in a band [au2017, ch. 13]: F_k are independent complex Gaussian
/// numbers of the covariance
///
///     E_k = [phi_1 h_1k, phi_2 h_2k] S [phi_1 h_1k, phi_2 h_2k]^H + S_e 1,
///     h_ik = (i b)^q / (1 - b^2 + 2 i zeta_i b),   b = f_k / f_i,
///
/// with S (2 x 2, Hermitian) of the modal forces, q = 0, 1, 2 of a displacement, a velocity, an acceleration.
/// Fisher scoring of -ln p = sum_k ln det E_k + F_k^H E_k^-1 F_k; covariances are inverses of the
/// information. Channels beyond six count by their six strongest combinations and the power of the rest.
/// @param one the likeliest single mode of the same band.
/// @param starts further pairs of frequencies to begin from [Hz]
/// @throws std::invalid_argument when the band has fewer than 16 coefficients.
AmbientPair ambient_pair(const BandCoefficients& band, const AmbientMode& one,
                         const std::vector<std::pair<double, double>>& starts, ResponseKind kind);

/// Mean square of the sums of a band's misfit over groups of neighbouring lines, each in its standard
/// deviations: about 1 where the spectrum is right, as chance makes the lines independent; more where it is
/// not. @param misfit of p channels, p on the average at each line (n)
/// @param lines in a group, about the width of a mode's peak; at least 8 are taken, so that sums are near
/// normal
/// @returns 1 for fewer than three groups
double band_dispersion(const Eigen::VectorXd& misfit, Eigen::Index channels, Eigen::Index lines);

}  // namespace beamid::experiments
