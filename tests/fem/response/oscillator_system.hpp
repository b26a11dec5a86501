// Systems of few coordinates whose motion is known in closed form.
#pragma once

#include <Eigen/LU>
#include <string>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::test {

fem::SparseMatrix sparse(const Eigen::MatrixXd& matrix);

/// Masses m_i [kg] in a row from the ground on, spring k_i [N/m] and dashpot c_i [N s/m] before each. Inputs:
/// a force on the last mass, and the acceleration of the base. Output: displacement of the last mass.
fem::StructuralSystem chain(const std::vector<double>& masses, const std::vector<double>& springs,
                            const std::vector<double>& dashpots);

/// m x'' + c x' + k x = f.
fem::StructuralSystem oscillator(double mass, double stiffness, double dashpot = 0.0);

Eigen::VectorXd one(double value);

/// Largest |a - b| over the largest |b|.
double relative_error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace beamid::test
