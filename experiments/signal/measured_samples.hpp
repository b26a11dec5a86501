// Signals of which some samples, NaN, were not measured.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

/// The signal (N) with straight lines across what is missing, level before the first and behind the last
/// sample that was measured: a first fill for fits that are iterated. Zero where nothing was measured.
Eigen::VectorXd first_fill(const Eigen::VectorXd& signal);

/// Largest magnitude of the samples that were measured; 0 where none was.
double largest_measured(const Eigen::MatrixXd& samples);

}  // namespace beamid::experiments
