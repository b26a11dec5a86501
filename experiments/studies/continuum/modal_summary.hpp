// The modes of a beam, and how far to trust each of their numbers.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/text/progress.hpp"
#include "fem/assembly.hpp"
#include "fem/complex_modes.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {

/// All (k); NaN where not known.
struct ModalSummary {
  Eigen::Index elements = 0, degrees_of_freedom = 0;
  fem::StructuralSystem system;  ///< empty, as are the shapes, when it is too large to be drawn
  fem::Modes modes;
  fem::Point observed;                   ///< what "release" refers to
  Eigen::VectorXd discretisation_error;  ///< relative, estimated (mode_trust.hpp)
  Eigen::VectorXd exact_frequency_hz;    ///< of the continuum
  Eigen::VectorXd mac;                   ///< with the exact shape, of deflections at the nodes
  Eigen::VectorXd effective_mass;        ///< (phi^T M r)^2 under a motion of the base, phi^T M phi = 1 [kg]
  Eigen::VectorXd release_amplitude;  ///< at the observed point, released from a unit static deflection [-]
  Eigen::VectorXd damping_ratio;      ///< by the damping law, dashpots aside
  std::optional<fem::ComplexModes> complex;                            ///< where dashpots act
  double total_mass = 0.0;                                             ///< all that moves [kg]
  double static_stiffness = std::numeric_limits<double>::quiet_NaN();  ///< at the observed point [N/m]
  std::vector<std::string> notes;  ///< what speaks against them, a sentence each

  Eigen::VectorXd frequency_hz() const { return modes.frequency_hz(); }
  Eigen::VectorXd exact_error() const;  ///< relative, of the frequency
};

/// @param count of modes, cut to what the mesh has.
/// @throws std::invalid_argument when the beam or its damping is impossible; std::runtime_error when it is
/// unstable.
ModalSummary summarise_modes(const Experiment& experiment, Eigen::Index count, const Progress& progress);

}  // namespace beamid::experiments
