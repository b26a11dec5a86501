// A chain of uniform pieces in harmonic motion: how many of its frequencies lie below a given one, and its
// modes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/exact/uniform_piece.hpp"

namespace beamid::fem {

/// What sits between two pieces: its dynamic stiffness is K - omega^2 M, and that of each absorber is added.
struct HarmonicNode {
  struct Absorber {
    double mass = 0.0, stiffness = 0.0;  ///< [kg], [N/m]
  };
  double position = 0.0;                                ///< [m]
  bool held[2] = {false, false};                        ///< deflection, rotation
  Eigen::Matrix2d mass = Eigen::Matrix2d::Zero();       ///< M of (w, theta) [kg, kg m, kg m2]
  Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();  ///< K [N/m, N, N m]
  std::vector<Absorber> absorbers;

  bool is_clamped() const { return held[0] && held[1]; }
};

/// Nodes 0..n with n pieces between them, clamped at its ends only.
///
/// The states that the part left of x admits are a plane in the space of the four amplitudes; a basis Y (4 x
/// 2) of it, kept orthonormal, is carried from the first node to the last over steps so short that nothing
/// overflows or cancels. [wittrick1971]: eliminating the nodes one after another from the dynamic stiffness,
/// the number of negative pivots is the number of frequencies below omega, no step having one of its own with
/// its ends held. The pivot block of a node, referred to that basis, is U^T (F + T12^-1 T11 U): Y = [U; F], T
/// the step beyond the node.
class HarmonicChain {
 public:
  std::vector<HarmonicNode> nodes;
  std::vector<UniformPiece> pieces;

  /// Number of frequencies in (0, omega), and those of rigid-body and of unstable motions.
  int count_below(double omega) const;

  /// Deflection at sorted positions [m] of the mode at frequency omega, about 1 at its largest; where two
  /// modes share the frequency, `which` is 0 or 1. Zero when only an absorber moves, on a beam that it cannot
  /// reach.
  Eigen::VectorXd deflection(double omega, int which, const std::vector<double>& positions) const;

 private:
  struct Sweep;
  StateScale scale(double omega) const;
  Sweep sweep(double omega, bool keep) const;
};

}  // namespace beamid::fem
