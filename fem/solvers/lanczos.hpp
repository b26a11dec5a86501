// A few lowest modes of a large system.
#pragma once

#include <Eigen/Core>

#include "fem/solvers/rigid_complement.hpp"
#include "fem/stiffness_solver.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Shapes (n x count) of the lowest modes that are not rigid, frequencies ascending: shift-invert Lanczos at
/// shift zero [parlett1998, ch. 13], on K^-1 M in the complement of the rigid-body motions, every vector kept
/// orthogonal to all before it. It is not restarted: the spectrum of a beam's K^-1 M falls like 1/i^4, so
/// that 2 count + 5 steps or so do.
///
/// From one start such a space sees one copy of a repeated frequency only (equal spans between clamps,
/// symmetric frames). A second one, started elsewhere in the complement of what was found, has to prove that
/// nothing lower is left; what it finds is taken in, and the search goes on. Its largest Ritz value is an
/// eigenvalue's to its own error, but which one's shows only once that pair has settled: what the start holds
/// little of comes up late.
///
/// Its Ritz values lie inside the spectrum, so a negative one proves a negative omega^2; where the rigidity
/// is indefinite there are always enough steps to bring out one that is not buried between others.
/// @throws std::runtime_error when it does not converge or a negative omega^2 shows up.
Eigen::MatrixXd lowest_shapes(const StructuralSystem& system, const StiffnessSolver& solver,
                              const RigidComplement& complement, Eigen::Index count);

/// @throws std::runtime_error that says what omega^2 [rad^2/s^2] is negative.
[[noreturn]] void throw_unstable(double square);

}  // namespace beamid::fem
