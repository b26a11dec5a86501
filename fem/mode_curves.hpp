// How natural frequencies and mode shapes move with a beam's parameters.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/modes.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::fem {

/// One mode near p_0, to the second order in x = p - p_0:
///
///     omega^2(p) = square + slope . x + x . curvature x / 2,      likewise every reading h phi(p)
///
/// for phi^T M(p) phi = 1 at every p.
struct ModeCurve {
  double square = 0.0;               ///< omega^2 [rad2/s2]
  Eigen::VectorXd square_slope;      ///< (q)
  Eigen::MatrixXd square_curvature;  ///< (q x q)

  Eigen::VectorXd reading;                         ///< H phi (p)
  Eigen::MatrixXd reading_slope;                   ///< (p x q)
  std::vector<Eigen::MatrixXd> reading_curvature;  ///< of reading i (q x q)
};

/// The curves of these modes. With F = K - omega^2 M and its derivatives F_j = K_j - (omega^2)_j M -
/// omega^2 M_j, the shapes' come from [nelson1976]
///
///     F phi_j = -F_j phi,      phi^T M phi_j = -phi^T M_j phi / 2
///
/// as one bordered system per mode, which is regular where F is not; the second derivatives from the same
/// system again.
/// @param modes of equations.system, none of them rigid, frequencies distinct
/// @throws std::invalid_argument when there is a rigid mode. @throws std::runtime_error when two modes share
/// a frequency.
std::vector<ModeCurve> mode_curves(const ParametricSystem& equations, const Modes& modes);

}  // namespace beamid::fem
