// Linear models with Gaussian noise, in matrices: their Kalman filter and smoother, which settle.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "filters/discrete_model.hpp"
#include "filters/measurements.hpp"

namespace beamid::filters {

/// x_k+1 = A x_k + G u_k + w,  y_k = H x_k + D u_k + v,  w ~ N(0, Q), v ~ N(0, R), x_0 ~ N(start).
struct LinearGaussian {
  Eigen::MatrixXd a, g;  ///< (n x n), (n x m)
  Eigen::MatrixXd h, d;  ///< (p x n), (p x m)
  Eigen::MatrixXd q, r;  ///< (n x n), (p x p)
  Gaussian start;        ///< of x_0, before y_0
};

/// A model whose motion is linear where some entries theta of its state are held: the matrices of the other
/// entries, at theta. @param held places of theta in the state (q)
LinearGaussian linear_gaussian(DiscreteModel& model, const std::vector<Eigen::Index>& held,
                               const Eigen::VectorXd& theta, const Gaussian& start, Eigen::Index inputs);

/// Covariances and gain at one sample, or at all samples from which on they stay the same.
struct KalmanStep {
  std::vector<Eigen::Index> seen;         ///< outputs that were read (p')
  Eigen::MatrixXd covariance;             ///< of x_k, before y_k (n x n)
  Eigen::MatrixXd gain;                   ///< K (n x p')
  Eigen::MatrixXd innovation_covariance;  ///< S (p' x p')
};

/// A record through the Kalman filter.
struct KalmanPass {
  Eigen::MatrixXd means;        ///< of x_k, before y_k (n x N)
  Eigen::MatrixXd innovations;  ///< e_k = y_k - E[y_k] (p x N); NaN where an output was not read
  std::vector<KalmanStep> steps;
  std::vector<std::size_t> step_of;  ///< (N)
  double cost = 0.0;                 ///< 1/2 sum_k (e_k^T S_k^-1 e_k + ln det S_k)

  const KalmanStep& step(Eigen::Index k) const { return steps[step_of[static_cast<std::size_t>(k)]]; }
};

/// Covariances are carried until they change by less than 1e-13 of themselves, from where on the gain is
/// that of the steady state: a sample then costs n^2 and not n^3.
/// @throws std::invalid_argument where stamps are uneven; std::runtime_error where the covariance of an
/// innovation is not positive definite, or the likelihood is not finite.
KalmanPass kalman_pass(const LinearGaussian& model, const Measurements& record, double interval);
/// Another record through the covariances and gains of a pass, which no reading changes: n^2 a sample.
/// @param record as long as the one of `like`, its outputs read where those were
/// @throws std::runtime_error where the likelihood is not finite
KalmanPass kalman_pass(const LinearGaussian& model, const Measurements& record, const KalmanPass& like);

/// @throws std::invalid_argument where stamps are not this far apart
void require_even_stamps(const Measurements& record, double interval);

/// C x_k + D u_k for every sample, given the whole record.
struct SmoothedRows {
  Eigen::MatrixXd means;       ///< (c x N)
  Eigen::MatrixXd deviations;  ///< (c x N)
};

/// The fixed-interval smoother. Means are those of Bryson and Frazier [bierman1977], without any inverse of a
/// covariance of the state: with L = A (I - K H), backwards from r = 0,
///
///     r <- H^T S^-1 e_k + L^T r,   x_k|N = x_k + P_k r
///
/// Covariances are those of two filters [fraser1969], Y_k what the readings from k on say of x_k, in which
/// what was not known before cancels nothing: where a start is poorly known, P_k - P_k W P_k has no digits
/// left.
///
///     P_k|N = (P_k^-1 + Y_k)^-1,   Y_k = H^T R^-1 H + A^T (Y_k+1^-1 + Q)^-1 A
///
/// @param rows C (c x n); @param feed D (c x m), empty: none
SmoothedRows smoothed_rows(const LinearGaussian& model, const Measurements& record, const KalmanPass& pass,
                           const Eigen::MatrixXd& rows, const Eigen::MatrixXd& feed);
/// Their means alone (c x N).
Eigen::MatrixXd smoothed_means(const LinearGaussian& model, const Measurements& record,
                               const KalmanPass& pass, const Eigen::MatrixXd& rows,
                               const Eigen::MatrixXd& feed);

}  // namespace beamid::filters
