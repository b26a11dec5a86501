// Static shapes of a structure that is held, or moved, at some points.
#pragma once

#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fem/solvers/rigid_complement.hpp"
#include "fem/stiffness_solver.hpp"
#include "fem/structural_system.hpp"
#include "filters/registry.hpp"

namespace beamid::reduction {

// Checks of options that several methods share.

/// Value of a number that counts something.
/// @throws std::invalid_argument "option 'modes' of reduction 'pod' is 1.5; expected a whole number from 1".
inline Eigen::Index count_option(const filters::Options& options, const std::string& name,
                                 const std::string& method, double least) {
  constexpr double most = 1e6;
  const double value = options.number(name);
  if (value >= least && value <= most && value == std::floor(value)) return static_cast<Eigen::Index>(value);
  std::ostringstream message;
  message << "option '" << name << "' of reduction '" << method << "' is " << value
          << "; expected a whole number from " << least << " to " << most;
  throw std::invalid_argument(message.str());
}

/// Value of a number above zero.
inline double positive_option(const filters::Options& options, const std::string& name,
                              const std::string& method) {
  const double value = options.number(name);
  if (value > 0.0 && std::isfinite(value)) return value;
  std::ostringstream message;
  message << "option '" << name << "' of reduction '" << method << "' is " << value
          << "; expected a finite number above 0";
  throw std::invalid_argument(message.str());
}

/// @throws std::invalid_argument when a method is to find more shapes than the system has coordinates.
inline void require_at_most(Eigen::Index count, Eigen::Index most, const std::string& name,
                            const std::string& method) {
  if (count > most)
    throw std::invalid_argument("option '" + name + "' of reduction '" + method + "' is " +
                                std::to_string(count) + "; expected at most " + std::to_string(most) +
                                " for this system");
}

// Which coordinates a method means by positions along a beam.

/// Deflection coordinates at the nodes nearest to `positions` [m]; without positions, those that the system's
/// outputs read, in their order and each once. Output rows that read more than one displacement (strains,
/// curvatures) are left out.
/// @param owner for messages: "reduction 'guyan'".
/// @throws std::invalid_argument when the system has no mesh, a position is not finite, off the beam or
/// nearest to a node that a support holds, two positions have the same nearest node, or there are no outputs.
std::vector<int> master_coordinates(const fem::StructuralSystem& system, const std::vector<double>& positions,
                                    const std::string& owner);

/// All coordinates, deflections and rotations, of the same nodes.
std::vector<int> interface_coordinates(const fem::StructuralSystem& system,
                                       const std::vector<double>& positions, const std::string& owner);

/// Columns of the system's inputs that are forces and not the acceleration of the base.
std::vector<int> force_inputs(const fem::StructuralSystem& system);

/// The column of the inputs that is the acceleration of the base across the beam; -1 where there is none.
int base_input(const fem::StructuralSystem& system);

// Static deflections of structures that may float.

/// q = K^-1 f; of a structure that can move without strain, the deflection of the load that is left when the
/// inertia of its rigid-body acceleration balances it, taken orthogonal (M) to the rigid-body modes R:
///
///     q = (I - R R^T M) K^- (I - M R R^T) f
class ElasticStatics {
 public:
  /// @throws std::runtime_error when the stiffness is singular for a reason other than rigid-body motions.
  explicit ElasticStatics(const fem::StructuralSystem& system)
      : solver_(system.stiffness), complement_(system.mass, solver_.rigid_motions()) {}

  /// q (n) of the load f (n).
  Eigen::VectorXd solve(const Eigen::VectorXd& load) const {
    Eigen::VectorXd balanced = load;
    for (int pass = 0; pass < 2; ++pass) complement_.project_load(balanced);
    // What the rigid-body acceleration takes up whole, as that of the base, leaves rounding only.
    if (!(balanced.norm() > 1e-12 * load.norm())) return Eigen::VectorXd::Zero(load.size());
    Eigen::VectorXd motion = solver_.solve(balanced);
    for (int pass = 0; pass < 2; ++pass) complement_.project_motion(motion);
    return motion;
  }

  const Eigen::MatrixXd& rigid_modes() const { return complement_.modes(); }  ///< R (n x k), R^T M R = I

 private:
  fem::StiffnessSolver solver_;
  fem::RigidComplement complement_;
};

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
