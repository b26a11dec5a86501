// Band-limited interpolation between stamps at unequal intervals.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

// Smooth interpolation between stamps at unequal intervals.

/// The cubic spline through (x, y), with the third derivative continuous at the second node from either end
/// (not-a-knot) [deboor2001, ch. IV]: its error falls as the fourth power of the intervals, up to the ends.
class CubicSpline {
 public:
  /// @param x (N), strictly increasing, N >= 4; @param y (N)
  /// @throws std::invalid_argument otherwise.
  CubicSpline(Eigen::VectorXd x, Eigen::VectorXd y);

  /// Its value; outside the nodes that of the outermost cubic.
  double operator()(double at) const;

  /// Its values at points (M).
  Eigen::VectorXd operator()(const Eigen::VectorXd& at) const;

 private:
  Eigen::VectorXd x_, y_;
  Eigen::VectorXd curvature_;  ///< (N), second derivatives at the nodes
};

// A signal some time earlier or later.

/// y(t_k + by) of a signal (N) at its own stamps, band-limited between them (interpolation.hpp); NaN where
/// that rests on what lies beyond the ends or on missing samples (NaN), 16 samples from them.
/// @param time (N), strictly increasing [s]; @param by [s], of either sign
/// @throws std::invalid_argument when fewer than four samples are there.
Eigen::VectorXd shifted(const Eigen::VectorXd& time, const Eigen::VectorXd& signal, double by);

/// y(t) = sum_j x_j h(t R - j), with R one over the widest interval (with more nodes the noise of the
/// readings would grow between them) and h a sinc under a Kaiser window that spans 16 nodes to either side
/// [oppenheim2010, sec. 7.5]. The x_j, on an even grid that reaches 16 nodes beyond both ends, are least
/// squares of y(t_k) = y_k, by conjugate gradients [bjorck1996, sec. 7.4] that begin at the cubic spline
/// through the stamps and are held there by a weak spring, four times, each time from where the one before
/// ended: what the stamps leave open stays the spline's (its point reflection, beyond the ends).
class BandLimited {
 public:
  /// @param time (N), strictly increasing [s], N >= 4; @param signal (N)
  /// @throws std::invalid_argument otherwise.
  BandLimited(Eigen::VectorXd time, const Eigen::VectorXd& signal);

  /// Nodes from either end within which values rest on the linear prediction.
  static constexpr Eigen::Index end_nodes = 32;

  /// Its values at points (M) from the first stamp to the last.
  Eigen::VectorXd operator()(const Eigen::VectorXd& at) const;

  double rate() const { return rate_; }  ///< R
  int iterations() const { return iterations_; }
  /// How far it misses the samples, rms over the signal's: what lies above half of R.
  double misfit() const { return misfit_; }

  /// The largest |sum_j e^(i 2 pi f (j - u)) h(u - j) - 1| over u: the error relative to its amplitude of a
  /// sine whose nodes are known. @param frequency f over R, from 0 to 0.5
  static double kernel_error(double frequency);

 private:
  double first_ = 0, rate_ = 1;  ///< of node `reach` [s], [1/s]
  Eigen::VectorXd nodes_;
  int iterations_ = 0;
  double misfit_ = 0;
};

/// The largest error of a straight line between even samples of a sine relative to its amplitude, half an
/// interval from both: 1 - cos(pi f). @param frequency f times the interval, from 0 to 0.5
double linear_interpolation_error(double frequency);

}  // namespace beamid::experiments
