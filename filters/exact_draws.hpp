// Random draws whose sample moments are exact.
#pragma once

#include "filters/random.hpp"

namespace beamid::filters {

/// k x N standard normal draws, then changed so that their rows have zero mean, the sample covariance I
/// (divisor N - 1), and no correlation with the rows of `others` (l x N) [pham2001], [hoteit2015]. Where N <
/// k + l + 1 there is no room for that: they are only centred, and the return says so by exact = false.
struct Draws {
  Eigen::MatrixXd values;  ///< k x N
  bool exact = false;
};
Draws exact_draws(RandomStream& random, Eigen::Index rows, Eigen::Index count, const Eigen::MatrixXd& others);

}  // namespace beamid::filters
