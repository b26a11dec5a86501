// The bridge between beams and filters: motion and unknown parameters in one state.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/models/parameter_choice.hpp"
#include "experiments/models/prior.hpp"
#include "experiments/models/springs/storey_spring.hpp"
#include "experiments/models/unknown.hpp"
#include "experiments/record/record.hpp"
#include "fem/damping.hpp"
#include "fem/structure.hpp"
#include "filters/continuous_model.hpp"
#include "filters/registry.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {

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
  double moved_share = 1.0;  ///< of the mass that a measured motion of the base moves (fem/moved_mass.hpp)

  Eigen::Index motion_size() const { return mode_shapes.rows(); }  ///< r
};

/// @throws std::invalid_argument where the record has a support_acceleration: only model beam takes one.
void require_no_supports(const std::string& model, const ModelSetting& setting);

using ModelRegistry = filters::Registry<JointModel, const ModelSetting&>;
ModelRegistry& model_registry();

}  // namespace beamid::experiments
