// Realisations of a linear system from data: of a free decay (ERA), and of random vibration with deviations.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/poles.hpp"

namespace beamid::experiments {

// The eigensystem realisation algorithm, and what each of several known poles contributes to a record.

// What each of several known poles contributes to a record.

/// Shapes of known poles, with the reconstruction and its residual.
struct ShapeFit {
  Eigen::MatrixXcd shapes;                      ///< (p x n)
  Eigen::MatrixXd reconstruction;               ///< (p x N)
  Eigen::VectorXd residual_standard_deviation;  ///< (p)
};

/// Shapes in y_i(t) = sum_m Re(shape_im e^(rate_m t)), t = 0 at the first sample, by linear least squares.
///
/// A rate with an imaginary part stands for itself and its conjugate. Growing modes are scaled at the
/// record's end, so that none overflows.
/// @param outputs (p x N), one column per instant
/// @param oscillating (n) whether the rate has an imaginary part that matters: others have real shapes
/// @throws std::invalid_argument when a rate or an output is not a finite number.
ShapeFit fit_shapes(const Eigen::MatrixXd& outputs, double interval,
                    const std::vector<std::complex<double>>& rates, const std::vector<bool>& oscillating);

/// The same of instants that increase as they like, t = 0 where they say (N) [s].
ShapeFit fit_shapes_at(const Eigen::MatrixXd& outputs, const Eigen::VectorXd& time,
                       const std::vector<std::complex<double>>& rates, const std::vector<bool>& oscillating);

// Modes of a free decay by the eigensystem realisation algorithm.

/// Order and limits of the realisation.
struct EigensystemSettings {
  int order = 0;           ///< poles; 0: singular values above noise_factor times their median, at most
  int largest_order = 20;  ///< this many
  double noise_factor = 3;
  Eigen::Index rows = 0;  ///< block rows of the Hankel matrix; 0: a third of the samples, at most 200 / p
  double smallest_amplitude = 1e-3;  ///< relative to the strongest mode; weaker ones are spurious
  double largest_damping_ratio = 0.3;
};

/// A pole s and what it contributes, y_i(t) = Re(shape_i e^(s t)), with t = 0 at the first sample.
struct IdentifiedMode {
  std::complex<double> rate;  ///< s = -damping ratio w + i w sqrt(1 - damping ratio^2) [rad/s]
  double frequency_hz = 0;    ///< undamped, |s| / (2 pi); 0 for a pole that does not oscillate
  double damping_ratio = 0;   ///< -Re s / |s|
  Eigen::VectorXcd shape;     ///< (p) [unit of the outputs]
  bool spurious = false;      ///< no oscillation, negative or excessive damping, or hardly any amplitude

  double amplitude(Eigen::Index output = 0) const { return std::abs(shape[output]); }
  double phase(Eigen::Index output = 0) const { return std::arg(shape[output]); }  ///< [rad]
};

/// The modes of a free decay, and what they leave of it.
struct EigensystemRealisation {
  std::vector<IdentifiedMode> modes;  ///< by rising frequency
  int order = 0;
  Eigen::VectorXd singular_values;              ///< of H(0), falling
  Eigen::MatrixXd reconstruction;               ///< (p x N), all modes
  Eigen::VectorXd residual_standard_deviation;  ///< (p)
};

/// Eigensystem realisation [juang1985] of a free decay. With the block Hankel matrices H(0) and H(1) of the
/// outputs y_k and y_(k+1), and H(0) = U S V^T cut off at the order n,
///
///     A = S^(-1/2) U^T H(1) V S^(-1/2),      s = log(eigenvalues of A) / dt.
///
/// U and S come from the Gram matrix H(0) H(0)^T, and H(1) V S = H(1) H(0)^T U, so that only matrices of p
/// rows squared appear, whatever the length of the record. The price: singular values below about 1e-8 of the
/// largest are lost. Shapes are the least-squares fit of all modes to the whole record.
/// @param outputs (p x N), one column per instant
/// @throws std::invalid_argument when N, rows and order do not fit, an output is not finite, or its square
/// leaves double precision.
EigensystemRealisation eigensystem_realisation(const Eigen::MatrixXd& outputs, double interval,
                                               const EigensystemSettings& settings = {});

/// The same for the orders 2, 4, ... up to largest_order (at most rows p), cut from one decomposition.
/// `settings.order` is not used. Reconstructions are left out.
std::vector<EigensystemRealisation> eigensystem_realisations(const Eigen::MatrixXd& outputs, double interval,
                                                             int largest_order,
                                                             const EigensystemSettings& settings = {});

/// Sizes of the Hankel matrix, and what its scatter is taken from.
struct StochasticSettings {
  Eigen::Index rows = 0;       ///< q; 0: p q of 100, less where segments were shorter than the 2 q lags
  Eigen::Index segments = 50;  ///< n_s, over which the scatter of the correlations is taken
};

/// What random vibration shows: poles of every model order, and the matrices that they were taken from.
struct StochasticSubspace {
  std::vector<OrderPoles> orders;
  Eigen::VectorXd singular_values;   ///< of H, falling
  Eigen::MatrixXd autocorrelations;  ///< (p x 2q) of each channel, lags dt to 2 q dt [unit^2]
};

/// Covariance-driven stochastic subspace identification [peeters1999]. With the output correlations
/// R_k = E[y(t + k) y(t)^T] in a block Hankel matrix H of q + 1 by q blocks R_(i+j-1), i, j from 1, and
/// H = U S V^T cut off at the order n, O = U_n is observability times a change of coordinates:
///
///     A = O_up^+ O_down,      C = first p rows of O,      s = log(eigenvalues of A) / dt,     shapes C phi
///
/// Standard deviations [reynders2008], [doehler2013]: the record in n_s segments gives as many H_j about
/// their mean H, hence cov(vec H) = sum_j (H_j - H)(H_j - H)^T / (n_s (n_s - 1)). Each H_j - H is carried to
/// the poles to first order, through U_n (with E = U^T (H_j - H) V, for k > n >= i)
///
///     dU_n = U_rest W,     W_ki = (s_i E_ki + s_k E_ik) / (s_i^2 - s_k^2)
///
/// and through O_up^+. They hold for segments that are long beside the decay of the modes.
/// @param outputs (p x N), one column per instant; their means are removed
/// @param largest_order orders are 2, 4, ... up to it and p q at most
/// @throws std::invalid_argument when the record is too short for rows and segments, or not finite.
StochasticSubspace stochastic_subspace(const Eigen::MatrixXd& outputs, double interval, int largest_order,
                                       const StochasticSettings& settings = {});

}  // namespace beamid::experiments
