// What noise and sampling leave unknown of the force that frequency responses divide by.
#pragma once

#include "experiments/modal/hammer_response.hpp"

namespace beamid::experiments {

/// Relative errors of the averaged force (F x q): each column is one standard deviation of an error that is
/// independent of the others' and smooth over the lines. No residual shows them.
struct ForceErrors {
  /// Noise in the force window: sum_h conj(F_h) N_h / sum_h |F_h|^2, some samples that no line of the band
  /// tells apart in each column.
  Eigen::MatrixXcd noise;
  /// Aliases of the pulse (hit_sampling.hpp), in phase with it and across: the latter vanish at zero
  /// frequency, as the pulse's spectrum at the sampling rate turns by 2 pi f over half its length.
  Eigen::MatrixXcd aliases;
};

/// @param first, lines of the band
ForceErrors force_errors(const HammerResponses& responses, Eigen::Index first, Eigen::Index lines);

}  // namespace beamid::experiments
