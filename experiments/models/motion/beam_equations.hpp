// The finite-element beam with its unknowns, as an identification setting describes it.
#pragma once

#include <vector>

#include "experiments/models/motion/parametric_motion.hpp"
#include "experiments/models/motion/second_order_motion.hpp"
#include "fem/modes.hpp"
#include "fem/structural_system.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

// Damping of the beam model: what the described law gives and what the record is asked about.

/// What is assumed of damping choices beforehand: the law's ratio of the mode, or of the first one for all
/// modes together, 1 % where no damping is described; alpha and beta of Rayleigh's law, else 0; all of them
/// to as much again. Other choices are left alone.
/// @param frequencies omega of the modes that are damped, ascending [rad/s]
/// @throws std::invalid_argument, or an InputError at a choice's place, when there is no such mode.
void add_damping_defaults(const fem::DampingLaw& law, const Eigen::VectorXd& frequencies,
                          const std::vector<ParameterChoice>& choices,
                          std::vector<ParameterDefault>& defaults);

/// Fills in damped modes, alpha and beta. Laws that are alpha M + beta K stay so where no damping ratio is
/// asked about; otherwise, and for the other laws, every mode has the ratio that the law gives it.
/// @param modes the damping of each mode, ratio and unknown still open
void describe_damping(const fem::DampingLaw& law, const Eigen::VectorXd& frequencies,
                      std::vector<DampedMode> modes, MotionDescription& description);

/// The quantity of the beam itself that a choice asks about; nothing for damping.
std::optional<fem::BeamParameter::Quantity> beam_quantity(const std::string& name);

/// What [[parameters]] may ask the structure itself about, its damping included.
const std::vector<std::string>& structure_quantities();

/// What the model assumes of each choice about the structure by itself: the value described, stiffnesses,
/// factors and the axial load to 30 %, masses to 10 %; of dampings nothing.
/// @throws std::invalid_argument, or an InputError at a choice's place, when the structure has no such thing.
std::vector<ParameterDefault> beam_defaults(const fem::Structure& structure,
                                            const std::vector<ParameterChoice>& choices);

/// The equations with the guesses as p_0; output row i is what observation i reads.
/// @param unknowns those of the choices, in their order
/// @throws std::invalid_argument when the setting lacks the beam, or the system has nonlinear forces, or its
/// mesh lacks nodes at the regions' ends where strain is observed.
fem::ParametricSystem beam_equations(const ModelSetting& setting, const std::vector<Unknown>& unknowns);

/// The unknowns that are about the structure itself, of those of all choices.
std::vector<Unknown> properties_of(const std::vector<ParameterChoice>& choices,
                                   const std::vector<ParameterDefault>& defaults);

/// Fills in the reference and what each of the description's unknowns drives.
void add_drives(const fem::ParametricSystem& equations, MotionDescription& description);

/// Factors (k) by which modes become 1 at the output where they are largest; where the outputs see no
/// displacement, 1 at the node where they are largest, and 1 without a mesh.
/// @param shapes of the modes on the mesh (n x k)
Eigen::VectorXd scale_of_modes(const fem::StructuralSystem& system,
                               const std::vector<Observation>& observations, const Eigen::MatrixXd& shapes);

/// M, K, E on these shapes: modes of a reduced model lifted to the mesh.
/// @param frequencies of the modes [rad/s]; @param forces columns of E that are kept
ReducedEquations on_shapes(const fem::ParametricSystem& equations, const Eigen::MatrixXd& shapes,
                           const Eigen::VectorXd& frequencies, const std::vector<Eigen::Index>& forces);

/// The same modes' damping on the whole mesh.
std::vector<DampedMode> damped_modes(const fem::ParametricSystem& equations, const fem::Modes& modes);

}  // namespace beamid::experiments
