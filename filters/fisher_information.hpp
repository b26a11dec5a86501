// How much a record can tell at most.
#pragma once

#include "filters/discrete_model.hpp"

namespace beamid::filters {

/// Fisher information (n x n) about the initial state z_0 (parameters included) in `samples` outputs of a
/// motion without process noise that starts at z_0, noise R on the outputs, no prior [kay1993, ch. 3]:
///
///     I = sum_k (H_k T_k)^T R^-1 (H_k T_k),   T_k = J_k-1 ... J_0
Eigen::MatrixXd fisher_information(DiscreteModel& model, const Eigen::VectorXd& initial_state,
                                   Eigen::Index samples);

/// Cramer-Rao bound on the standard deviation of every entry of z_0: sqrt of the diagonal of I^-1 (n).
/// @throws std::invalid_argument when the information is singular: some combination is not determined.
Eigen::VectorXd cramer_rao_bound(const Eigen::MatrixXd& information);

}  // namespace beamid::filters
