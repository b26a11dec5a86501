// Poles of a record with measured inputs, by output error on the lines of its spectrum.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <utility>
#include <vector>

namespace beamid::experiments {

/// Lines of p outputs and m inputs within a band, each transform over sqrt(N).
struct DrivenLines {
  double interval = 0.0;             ///< [s]
  Eigen::VectorXd omega;             ///< (L) [rad/s]
  Eigen::MatrixXcd outputs, inputs;  ///< (p x L), (m x L)
};

/// @throws std::invalid_argument when the band holds fewer than 16 lines.
DrivenLines driven_lines(const Eigen::MatrixXd& outputs, const Eigen::MatrixXd& inputs, double interval,
                         std::pair<double, double> band_hz);

/// With s = i omega, K modes and real coefficients b, b', d, d', d'', at every line
///
///     y_o = sum_j [sum_m (b_ojm + b'_ojm s) / (s^2 + 2 zeta_m w_m s + w_m^2) + d_oj + d'_oj s^2 + d''_oj /
///     s^2] u_j + z_o
///
/// fits any motion of any linear structure whose other modes lie outside the band. z_o is what the record's
/// ends add because it does not repeat itself: for each mode Re and Im of c / (1 - e^(p_m dt - s dt)), a
/// constant and a slope [pintelon2012, ch. 6]. All but w_m and zeta_m are linear and projected out
/// [golub1973]; ln w_m and ln zeta_m are found by Levenberg-Marquardt.
struct DrivenPoles {
  std::vector<std::complex<double>> rates;  ///< K, p_m [rad/s]
  Eigen::MatrixXcd residual_shapes;         ///< (p m x K) b + b' p_m; channel i to input j in row i + p j
  /// (2K x 2K) of ln w_1, ln zeta_1, ln w_2, ...: sandwich over the lines [white1982], or over sections of
  /// the record where they scatter more
  Eigen::MatrixXd covariance;
  Eigen::VectorXd left;       ///< (p) root mean square of what is left of the lines [unit]
  Eigen::MatrixXcd transfer;  ///< (p m x L) from input j to channel i in row i + p j
  Eigen::VectorXd share;      ///< (K) of the outputs' size that goes with the mode
  Eigen::VectorXd ratio;      ///< (K) squares that go with it, over those that noise around it would take
  double left_share = 0.0;    ///< of the outputs' size; channels weighed by their size
};

/// @param rates where to start
/// @throws std::runtime_error when nothing is found that is finite.
DrivenPoles fit_driven_poles(const DrivenLines& lines, const std::vector<std::complex<double>>& rates);

/// Where one pole more would reduce the residual of a fit most: among frequencies of the band, a twelfth of
/// an octave or two lines apart, and damping ratios of 0.5, 2 and 6 %, by what the columns of the fit leave
/// of its columns. Without any rates, of the record itself.
std::complex<double> next_pole(const DrivenLines& lines, const std::vector<std::complex<double>>& rates,
                               const Eigen::VectorXd& left);

/// Covariance (2K x 2K) from the scatter of the poles over sections whose numerators are their own:
///
///     V = S / (S - 2) I^-1 [sum_i (s_i - s)(s_i - s)^T] I^-1,   mode by mode
///
/// with s_i the slope of section i's squares and I the sum of their informations [liang1986].
Eigen::MatrixXd scatter_over(const std::vector<DrivenLines>& sections, const DrivenPoles& fit);

}  // namespace beamid::experiments
