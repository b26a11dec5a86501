// The modes of a beam, and how far to trust each of their numbers.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/config/experiment.hpp"
#include "experiments/text/progress.hpp"
#include "fem/assembly.hpp"
#include "fem/complex_modes.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {

// How far to trust computed modes.

/// Relative error of the frequencies of `modes` (k), estimated from meshes with every element cut in two and
/// in four. With d1 = f / f_2 - 1 and d2 = f_2 / f_4 - 1 it is |d1| / (1 - r), r = |d2 / d1|, which is 2^-p
/// where the error falls as h^p, from the element's own order 2^-4 (lumped 2^-2) to 3/4, and at least |d1 +
/// d2|: sharp tips, boundary layers and short segments have orders of their own. NaN for rigid-body modes.
Eigen::VectorXd discretisation_error(const fem::Modes& modes, const fem::Modes& halved,
                                     const fem::Modes& quartered, double order);

/// Likewise from a mesh of elements `ratio` times as long, |f_coarse / f_fine - 1| / (ratio^order - 1), the
/// order being known. NaN also for modes that the coarse mesh does not have.
Eigen::VectorXd discretisation_error(const fem::Modes& fine, const fem::Modes& coarse, double ratio,
                                     double order);

/// A sentence for each mode whose numbers disagree: fewer than 8 digits common to the solver's frequency and
/// to the Rayleigh quotient of its shape, or a residual above 1e-6.
std::vector<std::string> accuracy_notes(const fem::Modes& modes);

/// The value, or 0 where it is below 1e-12 of `scale`: rounding's share of what symmetry makes zero would
/// read like a result.
double rounded(double value, double scale);

/// All (k); NaN where not known.
struct ModalSummary {
  Eigen::Index elements = 0, degrees_of_freedom = 0;
  fem::StructuralSystem system;  ///< empty, as are the shapes, when it is too large to be drawn
  fem::Modes modes;
  fem::Point observed;                   ///< what "release" refers to
  Eigen::VectorXd discretisation_error;  ///< relative, estimated (modal_summary.hpp)
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
