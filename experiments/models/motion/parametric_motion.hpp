// Linear motion with unknowns in its equations, whatever its matrices are stored as:
//
//     M(p) q'' + C(p) q' + K(p) q = E(p) f,    C = C_0 + alpha M + beta K + sum_i c_i(p) g_i(p) g_i(p)^T
//
// M, K and E are affine in the properties p_1 .. p_a of the beam; the last sum is the damping of single
// modes. Dense equations of a reduced model (dense_equations.hpp) and the sparse ones of the whole mesh
// (fem/parametric_system.hpp) go with the same description.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/models/joint_model.hpp"
#include "experiments/models/unknown.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

/// What one unknown stands for in the equations.
struct Drive {
  enum class Kind {
    property,          ///< p_index: derivative `index` of M, K and E
    damping_ratio,     ///< xi of every damped mode that names this unknown
    mass_damping,      ///< alpha [1/s]
    stiffness_damping  ///< beta [s]
  };
  Kind kind = Kind::property;
  Eigen::Index index = -1;  ///< of a property, 0 .. a - 1
};

/// Viscous damping of one mode. Its shape phi is that at the guess p_0, phi^T M(p_0) phi = 1, its frequency
/// the Rayleigh quotient of that shape, right to the second order in p - p_0 [rayleigh1877]:
///
///     c g g^T,   g = M(p) phi,   mu = phi^T M(p) phi,   omega^2 = phi^T K(p) phi / mu,   c = 2 xi omega / mu
struct DampedMode {
  Eigen::VectorXd momentum;          ///< M(p_0) phi (n)
  Eigen::MatrixXd momentum_slopes;   ///< M_j phi (n x a)
  Eigen::VectorXd mass_slopes;       ///< phi^T M_j phi (a)
  double stiffness = 0.0;            ///< phi^T K(p_0) phi, the square of omega_0
  Eigen::VectorXd stiffness_slopes;  ///< phi^T K_j phi (a)
  double ratio = 0.0;                ///< xi as described, where no unknown drives it
  Eigen::Index unknown = -1;         ///< that drives xi; -1: none
  Eigen::Index number = 0;           ///< among the modes that are no rigid motion, from 0
};

/// A damped mode at some p: c g g^T and its derivatives.
struct ModeDamping {
  double factor = 0.0;          ///< c
  double by_ratio = 0.0;        ///< dc/dxi
  Eigen::VectorXd by_property;  ///< dc/dp_j (a)
  Eigen::VectorXd momentum;     ///< g (n); dg/dp_j is column j of momentum_slopes
};

/// @param change p - p_0 of the properties (a)
/// @throws std::runtime_error when the mode has lost its mass or its stiffness (an axial load beyond
/// buckling).
ModeDamping damping_at(const DampedMode& mode, const Eigen::VectorXd& change, double ratio);

/// What is common to all ways to store the matrices.
struct MotionDescription {
  std::vector<Unknown> unknowns;                       ///< q
  std::vector<Drive> drives;                           ///< q
  Eigen::VectorXd reference;                           ///< p_0 (a)
  std::vector<DampedMode> damped_modes;                ///< none without modal damping
  double mass_damping = 0.0, stiffness_damping = 0.0;  ///< alpha, beta where no unknown drives them

  std::vector<Observation> observations;  ///< p: displacement, velocity, acceleration or strain
  std::vector<Eigen::Index> forces;       ///< columns of E that are measured (m)
  /// Which of them is the acceleration of the base, -1: none. Sensors of acceleration show it too.
  Eigen::Index base = -1;
  Eigen::MatrixXd carried;  ///< share of each input that a sensor of acceleration shows by itself (p x m)

  bool sensor_bias = false;   ///< every sensor of acceleration has an unknown bias b [m/s2]
  bool sensor_drift = false;  ///< and a drift d, b' = d [m/s3]

  Eigen::Index properties() const { return reference.size(); }  ///< a
};

/// Where things stand in the state. What moves comes first: [q, q', (b, d) of drifting sensors, eta, b of
/// the others].
struct StateLayout {
  Eigen::Index coordinates = 0;             ///< n
  Eigen::Index motion = 0;                  ///< 2n and the drifting offsets: what is not constant
  Eigen::Index unknowns = 0;                ///< place of the first eta
  Eigen::Index size = 0;                    ///< of the state
  std::vector<Eigen::Index> biases;         ///< place of each observation's bias (p), -1: none
  std::vector<Eigen::Index> drifts;         ///< likewise
  std::vector<JointModel::Offset> offsets;  ///< the same as a joint model tells them
};
StateLayout layout(const MotionDescription& description, Eigen::Index coordinates);

/// Of the entry that carries an unknown: its own name and unit where that is the unknown itself.
filters::Label state_label(const Unknown& unknown);

/// Labels of a state in this layout; those of coordinates are "NAME_1", "NAME_1_rate", ...
std::vector<filters::Label> state_labels(const MotionDescription& description, const StateLayout& layout,
                                         const std::string& name);
std::vector<filters::Label> output_labels(const MotionDescription& description);

/// The unknowns of a state in physical units, sorted by what they drive.
struct PhysicalValues {
  Eigen::VectorXd values;                              ///< of the unknowns (q)
  Eigen::VectorXd slopes;                              ///< dp/deta (q)
  Eigen::VectorXd change;                              ///< p - p_0 of the properties (a)
  Eigen::VectorXd ratios;                              ///< xi of the damped modes
  double mass_damping = 0.0, stiffness_damping = 0.0;  ///< alpha, beta
};
PhysicalValues physical_values(const MotionDescription& description, const StateLayout& layout,
                               const Eigen::VectorXd& state);

/// Whether observation i reads the coordinates, their rates or their accelerations.
enum class Reads { coordinates, rates, accelerations };
Reads reads(Quantity quantity);

// What models of several observations have in common: which sensors there are and what is unknown of them.

/// sensor_bias and sensor_drift.
std::vector<filters::OptionSpec> sensor_options();

/// Share of the base's acceleration that each output shows (p).
Eigen::VectorXd base_shares(const fem::StructuralSystem& system);

/// Observations, forces and sensors' offsets.
/// @throws std::invalid_argument when nothing is observed, a force is, an input does not exist, or there is a
/// drift without a bias.
MotionDescription describe_sensors(const std::string& model, const ModelSetting& setting,
                                   const filters::Options& options);

}  // namespace beamid::experiments
