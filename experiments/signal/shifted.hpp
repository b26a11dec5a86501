// A signal some time earlier or later.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

/// y(t_k + by) of a signal (N) at its own stamps, band-limited between them (band_limited.hpp); NaN where
/// that rests on what lies beyond the ends or on missing samples (NaN), 16 samples from them.
/// @param time (N), strictly increasing [s]; @param by [s], of either sign
/// @throws std::invalid_argument when fewer than four samples are there.
Eigen::VectorXd shifted(const Eigen::VectorXd& time, const Eigen::VectorXd& signal, double by);

}  // namespace beamid::experiments
