// Static shapes of a structure that is held, or moved, at some points.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::reduction {

/// Motions of least strain energy under constraints, c of them:
///
///     minimise 1/2 q^T K q - f^T q   subject to   G q = d
///
/// with natural forces N and forces of constraint lambda from one sparse LU of
///
///     [ -D^-1  B   0  ] [   N    ]   [ 0 ]
///     [  B^T   0  G^T ] [   q    ] = [ f ]
///     [   0    G   0  ] [ lambda ]   [ d ]
///
/// so that no stiffness matrix, whose small eigenvalues rounding has taken, is ever assembled. Moving
/// coordinates (rows of I in G) gives Guyan's shapes; G may as well read the deflection between nodes.
class ConstrainedStatics {
 public:
  /// @param constraints G (c x n), independent rows
  /// @param owner for messages: "reduction 'guyan'"
  /// @throws std::invalid_argument when the constraints leave a motion without strain or depend on each
  /// other.
  ConstrainedStatics(const fem::StructuralSystem& system, const fem::SparseMatrix& constraints,
                     const std::string& owner);
  ~ConstrainedStatics();

  /// q (n x c) of a unit of each constraint's d, f = 0.
  const Eigen::MatrixXd& unit_shapes() const { return unit_shapes_; }

  /// q (n x k) under the loads f (n x k), d = 0.
  Eigen::MatrixXd deflection_under(const Eigen::MatrixXd& loads) const;

 private:
  struct Factorisation;
  std::unique_ptr<Factorisation> factorisation_;
  Eigen::MatrixXd unit_shapes_;

  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
};

/// Rows of I (c x n): the coordinates named are what is held or moved.
fem::SparseMatrix unit_rows(const std::vector<int>& coordinates, Eigen::Index size);

}  // namespace beamid::reduction
