// Samples that are missing, NaN, between others.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace beamid::experiments {

/// Runs of samples that are not finite: first sample and number.
std::vector<std::pair<Eigen::Index, Eigen::Index>> gaps_in(const Eigen::VectorXd& signal);

/// Those of several values that are finite, in their order.
std::vector<double> finite(std::vector<double> values);

/// A signal (N) with straight lines across what is missing, level beyond the first and last finite sample.
/// @throws std::invalid_argument when no sample is finite.
Eigen::VectorXd bridged_straight(const Eigen::VectorXd& signal);

/// Largest magnitude of the samples that are finite; 0 where none is.
double largest_measured(const Eigen::MatrixXd& samples);

/// Root mean square of every row's samples that are finite (p); 0 where none is.
Eigen::VectorXd root_mean_squares(const Eigen::MatrixXd& samples);

/// A signal (N) of a few lines, the strongest of `period` samples, whose missing samples are filled in:
/// around each, over four periods of the strongest line, least squares of the finite samples give
///
///     y_k = a + b t + (c + d t + e t^2) cos, sin(w_1 k) + sum_(i > 1) (c_i + d_i t) cos, sin(w_i k)
///
/// with up to three further lines w_i, each the largest in the spectrum of what those before it leave, as
/// long as one stands six times above its median; what the fit leaves is drawn straight across. A gap of half
/// a period of a decay is filled as if nothing had been missing; gaps of a period and more are not to be.
/// @param signal finite at both ends
Eigen::VectorXd filled(const Eigen::VectorXd& signal, double period);

}  // namespace beamid::experiments
