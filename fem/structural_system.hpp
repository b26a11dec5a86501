// The equations of motion that full and reduced models share.
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "fem/mesh.hpp"

namespace beamid::fem {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Stiffness kept as its natural-strain factors, K = B^T D B.
///
/// The assembled K of a fine beam has lost its small eigenvalues to rounding; its factors have not: the
/// entries of B are 0 and +-1 on a uniform mesh, and D is block diagonal. The rows of B come in the order in
/// which they determine the coordinates, one after another, which is what the solver goes by
/// (stiffness_solver.hpp).
struct StrainFactors {
  SparseMatrix strain;       ///< B (s x n): coordinates -> natural strains
  SparseMatrix rigidity;     ///< D (s x s): symmetric, positive definite unless an axial load softens it
  SparseMatrix flexibility;  ///< D^-1 (s x s), from its own closed form and not from inverting D

  /// K = B^T D B (n x n), for the solvers that need it assembled.
  SparseMatrix assembled() const { return strain.transpose() * rigidity * strain; }

  /// Twice the strain energy, (B q)^T D (B q) [J] for q (n): accurate where q^T K q is not.
  double energy(const Eigen::VectorXd& q) const {
    const Eigen::VectorXd e = strain * q;
    return e.dot(rigidity * e);
  }
};

/// What one coordinate of a system measures: displacements along x (axial), y (deflection) and z (lateral),
/// rotations about z (rotation), x and y. A plane structure has no lateral and no rotation but that about z.
struct Coordinate {
  enum class Kind { axial, deflection, rotation, generalised, lateral, rotation_x, rotation_y };
  Kind kind = Kind::generalised;
  double position = 0.0;  ///< along the beam [m]; meaningless when generalised
  double scale = 1.0;     ///< coordinate = scale x (displacement [m] or rotation [rad])
  int node = -1;          ///< of the mesh, or the number of an unknown without one; -1 when generalised
};

/// A force between the ground and one point that is not linear: -(k3 x^3 + c2 |x'| x') c, x = c^T q.
struct NonlinearForce {
  SparseMatrix direction;          ///< c (n x 1)
  double cubic_stiffness = 0.0;    ///< k3 [N/m3]
  double quadratic_damping = 0.0;  ///< c2 [N s2/m2]
};

/// M q'' + C q' + K q = E f + nonlinear forces,  y = H q.
///
/// n coordinates, m inputs (forces [N], accelerations of the base [m/s2]), p outputs (displacements [m]). A
/// reduction maps one such system to a smaller one (reduction/projection.hpp), so whatever runs on the
/// continuum runs on a reduced model.
struct StructuralSystem {
  std::vector<Coordinate> coordinates;    ///< n
  SparseMatrix mass;                      ///< M (n x n), symmetric positive definite
  SparseMatrix damping;                   ///< C (n x n), viscous
  StrainFactors stiffness;                ///< K = B^T D B
  SparseMatrix inputs;                    ///< E (n x m)
  SparseMatrix outputs;                   ///< H (p x n)
  std::vector<std::string> input_names;   ///< m
  std::vector<std::string> output_names;  ///< p
  Eigen::VectorXd base_shares = {};       ///< of the base's motion in an output's absolute one (p); empty: 1
  std::vector<NonlinearForce> nonlinear_forces;
  Mesh mesh;  ///< empty when reduced

  Eigen::Index size() const { return mass.rows(); }

  /// Whether the last input, the acceleration of the base, moves anything.
  bool is_moved_by_base() const {
    return inputs.cols() > 0 && !Eigen::MatrixXd(inputs.col(inputs.cols() - 1)).isZero(0.0);
  }

  /// How many nodes coordinates belong to: those of the mesh; without one each unknown is its own.
  Eigen::Index nodes() const {
    return mesh.nodes.empty() ? size() : static_cast<Eigen::Index>(mesh.nodes.size());
  }

  /// Where nodes are along x [m]; without a mesh their numbers, from 1.
  Eigen::VectorXd node_positions() const {
    return mesh.nodes.empty() ? Eigen::VectorXd::LinSpaced(size(), 1.0, static_cast<double>(size()))
                              : mesh.positions();
  }
};

}  // namespace beamid::fem
