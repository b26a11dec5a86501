// Whether chains agree, and how many independent draws they are worth.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

struct ChainConvergence {
  double r_hat = 1.0;  ///< the larger of that of the place and that of the spread
  double effective_draws = 0.0;
};

/// R-hat of one quantity, of halves of chains, by ranks; the smallest effective number of draws of its place,
/// its 5 % and its 95 % quantile [vehtari2021].
/// @param draws (draws x chains)
ChainConvergence chain_convergence(const Eigen::MatrixXd& draws);

}  // namespace beamid::experiments
