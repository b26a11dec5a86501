// How far to trust computed modes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/modes.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
