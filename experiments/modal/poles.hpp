// Poles of a modal analysis, which of them stay as the model order grows, and their real shapes.
#pragma once

#include <complex>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace beamid::experiments {

// A pole that a modal analysis found at one model order.

/// y(t) = Re(shape e^(rate t)) in a free decay. Deviations are NaN where the method knows none.
struct Pole {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::complex<double> rate;  ///< s = w (-damping ratio + i sqrt(1 - damping ratio^2)) [rad/s], Im s > 0
  Eigen::VectorXcd shape;     ///< (p) of any scale
  double frequency_deviation_hz = unknown;
  double damping_ratio_deviation = unknown;
  Eigen::VectorXd shape_deviation = {};  ///< (p) of |shape| scaled to 1 at its largest; empty: unknown

  double frequency_hz() const;   ///< undamped, |s| / (2 pi)
  double damping_ratio() const;  ///< -Re s / |s|

  /// Standard deviations of both, from the covariance (2 x 2) of Im s and -Re s [rad^2/s^2].
  void take_deviations(const Eigen::Matrix2d& covariance);
};

/// The oscillating poles of one model order, by rising frequency.
struct OrderPoles {
  int order = 0;
  std::vector<Pole> poles;
};

/// Modal assurance criterion |a^H b|^2 / (|a|^2 |b|^2) of two shapes (p) [allemang2003]; 1 for p = 1.
double modal_assurance(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b);

/// Modal phase collinearity of a shape (p) [pappa1993]: 1 when all channels move in phase or in opposition,
/// 0 when their phases are anything. With S the 2 x 2 matrix of products of real and imaginary parts, it is
/// ((Sxx - Syy)^2 + 4 Sxy^2) / (Sxx + Syy)^2.
double phase_collinearity(const Eigen::VectorXcd& shape);

// Which poles stay where they are as the model order grows: those of the structure.

/// How far a pole may move from order to order.
struct StabilisationSettings {
  double frequency_tolerance = 0.01;  ///< relative change from the order before
  double damping_tolerance = 0.1;     ///< of the damping ratio, relative
  double assurance_tolerance = 0.02;  ///< of 1 - MAC
  double cluster_distance = 0.02;     ///< |df| / f + |d damping ratio| / 2 + 1 - MAC, mean over two clusters
  double resolution_hz = 0;           ///< poles closer than that are one mode (free decay: 1 / duration)
  double largest_damping_ratio = 0.2;
  double largest_frequency_deviation = 0.02;  ///< relative, where the method knows it
  double fewest_orders = 0.3;                 ///< share of the orders at which a mode has to be stable
  std::pair<double, double> band_hz{0, 1e300};
};

enum class Stability { unstable, frequency, full };  ///< frequency only, or damping and shape too

/// A pole in the stabilisation diagram.
struct DiagramPole {
  int order = 0;
  Pole pole;
  Stability stability = Stability::unstable;
};

/// A cluster of poles over orders, as one.
struct PoleCluster {
  Pole pole;
  std::vector<int> orders;  ///< where it was stable
  std::string objection;    ///< why it is no mode of the structure; empty: it is one
};

/// The diagram and the modes that are stable in it.
struct Stabilisation {
  std::vector<DiagramPole> poles;     ///< within the band
  std::vector<PoleCluster> modes;     ///< by rising frequency
  std::vector<PoleCluster> rejected;  ///< likewise; of three poles at least
};

/// Stabilisation diagram and its reading by hierarchical clustering with average linkage [reynders2012].
///
/// A pole is stable when the order before has one within the tolerances. A cluster, one pole of each order,
/// becomes a mode by its stable poles: medians, or means weighted by inverse variance where deviations are
/// known. The deviation is then sqrt(1 / mean(1 / variance)): poles of several orders share their data, so
/// more orders make no mode more certain.
Stabilisation stabilise(const std::vector<OrderPoles>& orders, const StabilisationSettings& settings);

// Real shapes of modes that were measured with phases.

/// The real shape (p) nearest to a complex one: turned so that sum (Re)^2 is largest.
Eigen::VectorXd nearest_real(const Eigen::VectorXcd& shape);

}  // namespace beamid::experiments
