// Modes that were found, and how they change with the matrices.
#pragma once

#include "experiments/identify/update/predicted_modes.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {

struct FoundModes {
  Eigen::VectorXd eigenvalues;  ///< (m) with m >= k
  Eigen::MatrixXd shapes;       ///< (n x m), phi^T M phi = 1
  Eigen::MatrixXd compliance;   ///< S K^-1 (p x n); empty: the modes are all of them, or S is one point
};

/// What one parameter does to the matrices.
struct MatrixSlope {
  fem::SparseMatrix stiffness, mass;  ///< K_j, M_j (n x n)
};

/// The k lowest; where shapes at several points are to have slopes, twice as many and the static rest.
/// @throws std::runtime_error when there are no such modes.
FoundModes lowest_found_modes(const fem::StructuralSystem& system, Eigen::Index count, bool slopes);

/// The k lowest of them as sensors see them, without slopes.
/// @throws std::runtime_error when a mode has a negative stiffness.
PredictedModes seen_modes(const FoundModes& found, const fem::SparseMatrix& outputs, Eigen::Index count);

/// lambda' = phi^T (K_j - lambda M_j) phi [fox1968] and the change of each shape at the sensors.
void add_slopes(const FoundModes& found, const fem::SparseMatrix& outputs,
                const std::vector<MatrixSlope>& slopes, PredictedModes& modes);

}  // namespace beamid::experiments
