// The unknowns of a part from lines of a spectrum, inputs not exact.
#pragma once

#include <functional>
#include <optional>

#include <Eigen/Core>

#include "experiments/models/motion/supported_response.hpp"
#include "filters/gaussian.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

// A record as lines of its spectrum.

/// Discrete Fourier transforms over N samples, divided by sqrt(N): white noise of deviation sigma has
/// E |X|^2 = sigma^2 at every line.
struct RecordLines {
  Eigen::Index samples = 0;          ///< N
  double interval = 0.0;             ///< [s]
  Eigen::VectorXd omega;             ///< 2 pi k / (N dt), k = 1, 2, ... (L) [rad/s]
  Eigen::MatrixXcd outputs, inputs;  ///< (p x L), (m x L)
};

/// The lines above zero, up to a frequency; absent: 0.6 of half the sampling rate, below which the step
/// `decimate` lets nothing fold back (signal/decimation.hpp). Of the last samples as many are left out as the
/// transform's length needs to be a product of 2, 3 and 5.
/// @param inputs of the m (m x N); outputs are those of the record
/// @throws std::invalid_argument where stamps are uneven, a reading is missing, the frequency is not below
/// half the sampling rate, or there are fewer than 64 samples or 8 lines.
RecordLines record_lines(const filters::Measurements& record, const Eigen::MatrixXd& inputs,
                         const std::optional<double>& highest_hz);

/// What free motion has at these lines: real and imaginary part of each in turn, all outputs of one line,
/// then those of the next (p L x c); of length 1 each.
///
///     sum_t z^t e^(-i w t dt) = (1 - z^N) / (1 - z e^(-i w dt)),    z = e^(lambda dt)
Eigen::MatrixXcd free_lines(const SupportedResponse::FreeMotion& motion, const RecordLines& record);

/// With y_k and u_k the lines of what was read, G_k(theta) of a part (supported_response.hpp), R and R_u of
/// the sensors' noise, z free motion with real coefficients c, whatever the inputs were [pintelon2012]:
///
///     J(theta) = min over c of sum_k r_k^H S_k^-1 r_k + 1/2 |theta - theta_0|^2_(P_0^-1)
///     r_k = y_k - G_k u_k - Z_k c,    S_k = R + G_k R_u G_k^H
///
/// no ln det S_k (filters/innovation_likelihood.hpp, free_inputs). A line needs no path between samples: its
/// motion is G_k u_k exactly. What differs at the record's ends from motion that repeats itself is free
/// motion. Inputs come out as u^_k = u_k + R_u G_k^H S_k^-1 r_k, and with D_k = dG_k u^_k
///
///     dJ = -2 Re sum_k D_k^H S_k^-1 r_k,    I = 2 Re sum_k (D_k^H S_k^-1 D_k - noise of u^_k in it)
struct LineProblem {
  std::function<SupportedResponse(const Eigen::VectorXd& theta)> response;
  RecordLines record;
  Eigen::VectorXd output_noise, input_noise;  ///< standard deviations (p), (m)
  Eigen::Index unmeasured = 0;                ///< inputs whose noise has no bounds: each takes an output
  Eigen::Index free_modes = 0;                ///< whose free motion counts
  filters::Gaussian prior;                    ///< theta_0, P_0 (its covariance) (q)
};

/// The likeliest unknowns of a part, with their covariance.
struct LineFit {
  Eigen::VectorXd theta;        ///< (q)
  Eigen::MatrixXd information;  ///< I, without P_0 (q x q)
  Eigen::MatrixXd covariance;   ///< of theta, the noise of u^ counted (q x q)
  Eigen::VectorXd squares;      ///< r_k^H S_k^-1 r_k, 1 for each output to spare if noise is as stated (L)
  Eigen::VectorXd readings;     ///< y_k^H S_k^-1 y_k (L)
  double freedom = 0.0;         ///< of 2 times the sum of the squares
  bool converged = false;
};

/// By Levenberg-Marquardt from the best of theta_0 and `others`, derivatives of G central differences of
/// a thousandth of the deviations known beforehand.
/// @throws std::runtime_error where the part has no response at theta_0.
LineFit fit_lines(const LineProblem& problem, const std::vector<Eigen::VectorXd>& others);

}  // namespace beamid::experiments
