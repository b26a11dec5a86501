// The second-order system of a structure: M, C, the strain factors of K, and the laws that damp its modes.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "fem/beam.hpp"

namespace beamid::fem {

// The equations of motion that full and reduced models share.

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

// How much of a structure a motion of its base moves.

/// E^T M^-1 E of one input [kg for the base's acceleration]: with E = -M r the r^T M r of the rigid motion r,
/// of which every mode takes its effective mass (phi^T E)^2, phi^T M phi = 1, and all modes the whole.
double moved_mass(const StructuralSystem& system, Eigen::Index input);

/// Part of it that coordinates hold, 0 to 1. @param shapes (n x r) with Phi^T M Phi = 1
double moved_share(const StructuralSystem& system, Eigen::Index input, const Eigen::MatrixXd& shapes);

struct Undamped {};

/// xi_i of mode i; modes beyond the last entry get the last one.
struct ModalDamping {
  std::vector<double> ratios;  ///< at least one [-]
};

/// A frequency at which the damping ratio is known.
struct DampingAnchor {
  double frequency_hz = 0.0;
  double ratio = 0.0;
};

/// C = alpha M + beta K, hence xi(omega) = (alpha / omega + beta omega) / 2 [rayleigh1877].
struct RayleighDamping {
  DampingAnchor first, second;
};

/// C = M sum_j a_j (M^-1 K)^j, hence xi(omega) = 1/2 sum_j a_j omega^(2j-1), j = 0..k-1, through k anchors
/// [caughey1960]. One anchor is damping proportional to the mass, two are Rayleigh's.
struct CaugheyDamping {
  std::vector<DampingAnchor> anchors;  ///< at least one
};

/// Hysteretic, K (1 + i eta): harmonic motion only, for in time it would answer before it is asked
/// [crandall1970].
struct StructuralDamping {
  double loss_factor = 0.0;  ///< eta [-]
};

using DampingLaw = std::variant<Undamped, ModalDamping, RayleighDamping, CaugheyDamping, StructuralDamping>;

/// The law's name: undamped, modal, rayleigh, caughey or structural.
const char* name(const DampingLaw& law);

/// xi (k) that the law gives modes of these frequencies, in their order; eta / 2, what a hysteretic structure
/// shows at resonance, for structural damping. NaN where the frequency is zero: a rigid-body motion has no
/// critical damping.
/// @param angular_frequency omega (k) [rad/s], of modes 1 to k
/// @throws std::invalid_argument when the law is impossible (ratios missing, negative or not finite, anchors
/// at frequencies not positive or equal) or gives one of these modes a negative ratio, naming the mode.
Eigen::VectorXd damping_ratios(const DampingLaw& law, const Eigen::VectorXd& angular_frequency);

/// d = 2 xi omega (k) [1/s] of z'' + d z' + omega^2 z = 0, finite for rigid-body motions too.
/// @throws as damping_ratios; for structural damping always.
Eigen::VectorXd damping_rates(const DampingLaw& law, const Eigen::VectorXd& angular_frequency);

/// What a damping matrix that keeps the sparsity of M and K is made of, C = alpha M + beta K.
struct ProportionalDamping {
  double mass = 0.0;       ///< alpha [1/s]
  double stiffness = 0.0;  ///< beta [s]
};

/// alpha and beta of Rayleigh's law, of Caughey's with at most two anchors, and of no damping.
/// @throws std::invalid_argument for the others, whose matrices are full or none, saying what to use instead.
ProportionalDamping proportional_coefficients(const DampingLaw& law);

/// The matrix itself (n x n) [N s/m]. @throws as proportional_coefficients.
SparseMatrix proportional_damping(const DampingLaw& law, const StructuralSystem& system);

}  // namespace beamid::fem
