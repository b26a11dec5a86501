// How far to trust computed modes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/modes.hpp"

namespace beamid::experiments {

/// Relative error of the frequencies of `fine`, estimated from a mesh whose elements are `ratio` times as
/// long (k): |f_coarse / f_fine - 1| / (ratio^order - 1), order being that of the frequencies' error in the
/// element's length. NaN for rigid-body modes and those that the coarse mesh does not have.
Eigen::VectorXd discretisation_error(const fem::Modes& fine, const fem::Modes& coarse, double ratio,
                                     double order);

/// A sentence for each mode whose numbers disagree: fewer than 8 digits common to the solver's frequency and
/// to the Rayleigh quotient of its shape, or a residual above 1e-6.
std::vector<std::string> doubts(const fem::Modes& modes);

/// The value, or 0 where it is below 1e-12 of `scale`: rounding's share of what symmetry makes zero would
/// read like a result.
double rounded(double value, double scale);

}  // namespace beamid::experiments
