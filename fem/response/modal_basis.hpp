// Equations of motion in modal coordinates, q = Phi z.
#pragma once

#include "fem/damping.hpp"
#include "fem/modes.hpp"

namespace beamid::fem {

/// z'' + (diag(d) + c) z' + diag(omega^2) z = Gamma f,  y = H Phi z, k modes.
struct ModalBasis {
  Modes modes;
  Eigen::VectorXd square;    ///< omega^2 (k) [1/s2]
  Eigen::VectorXd rate;      ///< d (k) [1/s], zero for structural damping
  Eigen::MatrixXd coupling;  ///< c = Phi^T C Phi (k x k) [1/s], of the dashpots; empty without any
  Eigen::MatrixXd loads;     ///< Gamma = Phi^T E (k x m)
  Eigen::MatrixXd observed;  ///< H Phi (p x k)
};

/// @param count modes; 0: all of a system of at most 200 coordinates, 100 of a larger one.
/// @throws std::invalid_argument when count is not in 0..n or the law is impossible.
ModalBasis modal_basis(const StructuralSystem& system, const DampingLaw& damping, Eigen::Index count);

/// Static deflection under a unit of each input, of the modes left out (n x m): K^-1 (E - M Phi Gamma), what
/// rounding leaves of the modes themselves taken off.
Eigen::MatrixXd residual_deflection(const StructuralSystem& system, const ModalBasis& basis);

}  // namespace beamid::fem
