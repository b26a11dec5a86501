// The bridge between beams and filters: motion and unknown parameters in one state.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/models/springs/spring_law.hpp"
#include "experiments/models/unknown.hpp"
#include "experiments/record/record.hpp"
#include "fem/structural_system.hpp"
#include "fem/structure.hpp"
#include "filters/continuous_model.hpp"
#include "filters/gaussian.hpp"
#include "filters/registry.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {

// What is known of one degree of freedom before the record is seen.

/// Means and standard deviations; absent ones are worked out from the model and the record.
struct Prior {
  std::optional<double> stiffness, stiffness_deviation;  ///< [N/m]
  std::optional<double> damping_ratio, damping_ratio_deviation;

  bool states_stiffness() const { return stiffness || stiffness_deviation; }
  bool states_damping() const { return damping_ratio || damping_ratio_deviation; }
};

/// What one measured channel reads of the model: output row i of the system belongs to observation i.
struct Observation {
  Quantity quantity = Quantity::acceleration;
  std::string name = {};
};

/// Everything a model may be made from.
struct ModelSetting {
  fem::StructuralSystem system;  ///< the continuum as described; output row i is what observation i reads
  std::shared_ptr<const reduction::Reduction> reduction;  ///< absent: none
  reduction::Training training = {};
  std::vector<Observation> observations;    ///< p
  std::vector<Eigen::Index> forces = {};    ///< inputs of the system that the record holds, in its order (m)
  std::vector<Eigen::Index> supports = {};  ///< which of these are accelerations imposed where they act
  std::vector<ParameterChoice> parameters = {};   ///< none: what the model asks about by itself
  fem::DampingLaw damping = {};                   ///< as described; guesses of damping ratios come from it
  Prior prior = {};                               ///< of one degree of freedom
  std::vector<StoreySpring> storey_springs = {};  ///< of a chain, those that follow laws

  /// What the system was assembled from, for models that ask about the beam itself.
  struct Continuum {
    fem::Structure structure;
    int elements = 0;
    std::vector<fem::Point> points = {};  ///< of the system's inputs, and of its outputs but for the kind
  };
  std::optional<Continuum> continuum = {};
};

/// A system of one point observed in several ways: its first output row once per quantity.
ModelSetting at_one_point(const fem::StructuralSystem& system, const std::vector<Quantity>& observed);

/// The setting's system, reduced as it says; observation i still reads output row i.
reduction::ReducedModel reduced(const ModelSetting& setting);

/// State [z, z', theta, ...]: r coordinates, their rates, then in the model's own order the unknowns and the
/// sensors' offsets.
struct JointModel {
  std::shared_ptr<const filters::ContinuousModel> motion;
  std::vector<Unknown> unknowns;             ///< q
  std::vector<Eigen::Index> unknown_places;  ///< in the state (q)

  /// A sensor's bias [unit of the channel] or drift [that per s].
  struct Offset {
    Eigen::Index place = 0;    ///< in the state
    Eigen::Index channel = 0;  ///< of the record
    bool drift = false;
  };
  std::vector<Offset> offsets;
  std::vector<Eigen::Index> slips;  ///< places of displacements that lag behind z and may start anywhere [m]

  /// Modes of the model at the guess, in its coordinates z (r x k), each scaled so that the largest
  /// displacement among the outputs is 1: where the initial motion may point.
  Eigen::MatrixXd mode_shapes;
  Eigen::VectorXd mode_frequencies;  ///< omega (k) [rad/s]

  double equivalent_mass = 0.0;  ///< at the first output, of a model of one coordinate [kg]; else 0
  double moved_share =
      1.0;  ///< of the mass that a measured motion of the base moves (fem/structural_system.hpp)

  Eigen::Index motion_size() const { return mode_shapes.rows(); }  ///< r
};

/// @throws std::invalid_argument where the record has a support_acceleration: only model beam takes one.
void require_no_supports(const std::string& model, const ModelSetting& setting);

using ModelRegistry = filters::Registry<JointModel, const ModelSetting&>;
ModelRegistry& model_registry();

// The discretisation that errs least, for whoever needs the model's own motion and not a filter's.

/// Whether the model moves a mesh that nobody has reduced, which is not made into dense matrices.
bool is_whole_mesh(const JointModel& model);

/// Whether the model's outputs are no linear function of its start, its parameters given.
bool is_nonlinear(const JointModel& model);

/// Whether it is a chain whose storeys follow laws (storeys.hpp).
bool has_storey_laws(const JointModel& model);

/// The exact one; of a whole mesh the fourth-order one that is banded; of nonlinear motion the classical
/// Runge-Kutta step where an interval is short for it, as that of storeys always is (storey_motion.cpp), else
/// CVODES.
/// @param interval [s]; 0: so short that any fourth-order step will do
std::string finest_discretisation(const JointModel& model, double interval = 0.0);

// Modes of a joint model where its unknowns are now.

/// The model with the modes that it has at a state's unknowns (n) in place of those at the guesses. Of a mesh
/// that nobody has reduced they stay as they are.
/// @throws std::runtime_error when the model does not oscillate there in as many modes.
JointModel with_modes_at(JointModel model, const Eigen::VectorXd& state);

/// d[z, z']/d eta_j of a motion z = Phi a, z' = Phi b in the modes Phi(eta) of the model (n x q; zero below
/// the motion), by central differences of Phi.
///
/// Modes that a record does not hold stay at rest only when the start follows the modes. A start that is held
/// while the unknowns change excites the higher ones, in acceleration by (omega_i / omega_1)^2 times as much,
/// and a fit would rather keep the unknowns.
/// @param model its modes are those at the state (with_modes_at)
/// @returns zeros for a mesh that nobody has reduced
Eigen::MatrixXd motion_slopes(const JointModel& model, const Eigen::VectorXd& state);

// What is assumed before the record is seen.

/// How large the motion and the sensors' offsets may be.
struct StartScale {
  double displacement = 0.0;  ///< of the first mode, at the output where it is largest [m]
  double duration = 0.0;      ///< of the record [s]; a drift may add up to as much as a bias over it
};

/// From the largest reading of every channel, as a motion of the model's first mode would give it.
/// @param samples (p x N), observed as the observations say.
StartScale start_scale(const JointModel& model, const std::vector<Observation>& observations,
                       const Eigen::MatrixXd& samples, double duration);

/// The directions in which the initial state is uncertain, a column each: displacement and velocity of every
/// mode of the model, then the sensors' offsets, slips by as much
/// as the first mode, then the unknowns.
///
/// Mode i moves by up to `displacement` omega_1 / omega_i, which leaves all modes the same velocity: a blow
/// excites them so, a release the higher ones less.
struct StartDirections {
  Eigen::MatrixXd motion;    ///< (n x (2k + offsets + slips))
  Eigen::MatrixXd unknowns;  ///< (n x q)

  Eigen::MatrixXd all() const;  ///< side by side
};
StartDirections start_directions(const JointModel& model, const std::vector<Observation>& observations,
                                 const StartScale& scale);

/// At rest, the unknowns at their guesses; uncertain in the start directions. The covariance itself is formed
/// for small states only.
filters::Gaussian initial_estimate(const JointModel& model, const StartDirections& directions);

}  // namespace beamid::experiments
