// A structure given by its matrices, as another program has assembled them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/assembly.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::fem {

/// M q'' + C q' + K q = f with parameters theta,
///
///     M = M_0 + sum_j theta_j M_j,   C = C_0 + sum_j theta_j C_j,   K = K_0 + sum_j theta_j K_j
struct MatrixSystem {
  struct Parameter {
    std::string name;
    double value = 1.0;                     ///< theta_j [-]
    SparseMatrix mass, damping, stiffness;  ///< M_j, C_j, K_j (n x n); empty: zero
  };
  SparseMatrix mass, damping, stiffness;  ///< M_0, C_0, K_0 (n x n); an empty C_0 is zero
  std::vector<Parameter> parameters;
  std::vector<std::string> labels;  ///< of the unknowns q (n)
  Eigen::VectorXd base_motion;      ///< (n) of the unknowns when the base moves by 1 m; empty: not known

  Eigen::Index size() const { return mass.rows(); }
};

/// @throws std::invalid_argument naming the first matrix of another size, not symmetric or not finite, the
/// first label or parameter that is there twice.
void validate(const MatrixSystem& system);

/// The equations at theta, K = B^T B with B from Cholesky's factor, K = P^T L L^T P. K is what was given: its
/// small eigenvalues are as good as its digits. Unknowns are displacements; Point::place is the label of one.
/// @throws std::invalid_argument as validate(), when K is not positive definite, when a point is no label.
StructuralSystem assemble(const MatrixSystem& system, const std::vector<Point>& points);

/// The same with the derivatives that `parameters`, all of them factors by name, ask for.
ParametricSystem assemble_parametric(const MatrixSystem& system, const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters);

double value_of(const MatrixSystem& system, const BeamParameter& parameter);
MatrixSystem with_value(const MatrixSystem& system, const BeamParameter& parameter, double value);

}  // namespace beamid::fem
