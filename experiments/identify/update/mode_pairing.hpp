// Which predicted mode a measured one is.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/identify/update/predicted_modes.hpp"
#include "experiments/modal/modal_data.hpp"

namespace beamid::experiments {

/// For each row of the scores (a x b, a <= b) the column that makes their sum largest, no column twice
/// (Hungarian method [kuhn1955]).
std::vector<Eigen::Index> best_assignment(const Eigen::MatrixXd& scores);

/// MAC of measured and predicted mode (measured x k), NaN where no shape was measured. Of a predicted mode
/// with close neighbours that of the nearest shape in their common space.
Eigen::MatrixXd modal_assurances(const ModalData& data, const PredictedModes& modes);

/// MAC less |ln(f / f')| (measured x k), without MAC where no shape was measured.
Eigen::MatrixXd pairing_scores(const ModalData& data, const PredictedModes& modes,
                               const Eigen::MatrixXd& assurances);

/// The predicted mode, from 0, of each measured one. A number stated stays. Where shapes were measured, MAC
/// less |ln(f / f')| is made largest in sum; where none were, the modes are the lowest, in their order.
std::vector<Eigen::Index> pair_modes(const ModalData& data, const PredictedModes& modes);

}  // namespace beamid::experiments
