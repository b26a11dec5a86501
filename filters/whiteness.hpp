// Is a series white?
#pragma once

#include <Eigen/Core>

namespace beamid::filters {

/// How far a series is from white noise.
struct Whiteness {
  Eigen::VectorXd autocorrelation;  ///< at lags 1 to L (L); 0 when white
  double p_value = 0.0;             ///< Ljung-Box test over these lags [ljung1978]; below 0.05: not white
};

/// Of a series (N) whose NaN entries are missing. With r_k the correlation at lag k, of the n_k pairs that
/// are there, and n entries that are there,
///
///     Q = n (n + 2) sum_k r_k^2 / n_k
///
/// is chi-square of as many degrees as lags have pairs; n_k = n - k where nothing is missing. A series that
/// is constant, or beyond all bounds, has correlations of one.
Whiteness whiteness_of(const Eigen::VectorXd& series, Eigen::Index lags = 20);

}  // namespace beamid::filters
