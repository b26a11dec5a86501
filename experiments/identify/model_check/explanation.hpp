// Least squares of one or two changes on the differences of frequencies.
#pragma once

#include "experiments/identify/model_check/changed_frequencies.hpp"

namespace beamid::experiments {

/// (d_i / f_i)^2 + model_error^2 (n).
Eigen::VectorXd variances(const ModelCheck& check);

/// Gauss-Newton within what is possible, of several changes from several places; a change at its limit that
/// would go on is held there. Deviations from (J^T W J)^-1, times sqrt(chi^2 / freedom) where that is above
/// one.
Explanation explain(const ModelCheck& check, const ChangedFrequencies& frequencies,
                    const std::vector<std::size_t>& which);

}  // namespace beamid::experiments
