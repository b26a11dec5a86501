// A long curve thinned so that its picture stays the same.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamid::experiments {

/// Indices of the points to keep, ascending, at most about `limit`, all of up to one and a half times as
/// many: the first and the last, and the lowest and the highest of every interval, the intervals being
/// equally wide on the axis. Points that are not finite leave a gap and keep it.
///
/// @param x (N) abscissae. Where they do not ascend, the intervals hold equally many points instead.
/// @param y (N) ordinates.
/// @param logarithmic whether x is drawn on a logarithmic axis.
std::vector<Eigen::Index> envelope(const Eigen::VectorXd& x, const Eigen::VectorXd& y, bool logarithmic,
                                   Eigen::Index limit = 4000);

}  // namespace beamid::experiments
