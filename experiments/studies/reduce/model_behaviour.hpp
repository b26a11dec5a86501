// What a model of a beam does, full or reduced: the numbers in which models are compared.
#pragma once

#include <Eigen/Core>

#include "experiments/studies/reduce/release_decay.hpp"
#include "fem/modes.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {

/// Its modes, and those on the mesh.
struct ModelModes {
  fem::Modes modes;        ///< the lowest k of the model
  Eigen::MatrixXd shapes;  ///< psi = Phi z (n x k), psi^T M psi = 1

  Eigen::Index elastic() const { return modes.size() - modes.rigid; }  ///< modes with strain
};

/// The lowest modes, at least so many and all below a frequency, as far as the model has them; 200 at most.
fem::Modes lowest_modes(const fem::StructuralSystem& system, Eigen::Index at_least, double below_hz);

/// The same, lifted to the mesh.
ModelModes lowest_modes(const reduction::ReducedModel& model, Eigen::Index at_least, double below_hz);

/// Seen at output 0; NaN where the model can move without strain, or its mode does not move the point.
struct ModelBehaviour {
  double static_stiffness = 0.0;  ///< K, a force at input 0 per deflection there [N/m]
  double modal_mass = 0.0;        ///< M of its first mode with strain, scaled to 1 there [kg]
  Eigen::VectorXd receptance;     ///< magnitude at the frequencies asked for [m/N]
  fem::Motion decay;              ///< after the release
  double decay_seconds = 0.0;     ///< that it took, by the clock [s]
};

/// @param frequency_hz of the receptance, from input 0 to output 0.
/// @param damping of the receptance; that of the decay is the test's.
ModelBehaviour behaviour_of(const fem::StructuralSystem& system, const ModelModes& modes,
                            const fem::SparseMatrix& mass, const fem::DampingLaw& damping,
                            const Eigen::VectorXd& frequency_hz, const ReleaseTest& test);

}  // namespace beamid::experiments
