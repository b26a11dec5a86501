// How much a record can tell at most.
#pragma once

#include "filters/discrete_model.hpp"
#include "filters/information_factor.hpp"

namespace beamid::filters {

/// Fisher information (n x n) about the initial state z_0 (parameters included) in `samples` outputs of a
/// motion without process noise that starts at z_0, noise R on the outputs, no prior [kay1993, ch. 3]:
///
///     I = sum_k (H_k T_k)^T R^-1 (H_k T_k),   T_k = J_k-1 ... J_0
Eigen::MatrixXd fisher_information(DiscreteModel& model, const Eigen::VectorXd& initial_state,
                                   Eigen::Index samples);

/// The same about the r coefficients c of z_0 = initial_state + S_0 c, S_0 = directions (n x r), as a factor
/// that keeps the digits: for states of thousands of entries of which few combinations are unknown.
///
///     I = sum_k (H_k S_k)^T R^-1 (H_k S_k),   S_k+1 = J_k S_k by DiscreteModel::move()
///
/// @param inputs u_k in its columns, as DiscreteModel takes them (m (d + 1) x samples); empty: none.
/// @throws std::invalid_argument when shapes disagree or R is not positive definite; std::runtime_error when
/// the motion or its sensitivities do not remain finite.
InformationFactor information_factor(DiscreteModel& model, const Eigen::VectorXd& initial_state,
                                     Eigen::Index samples, const Eigen::MatrixXd& directions,
                                     const Eigen::MatrixXd& inputs = {});

/// information_factor(...).information() (r x r).
Eigen::MatrixXd fisher_information(DiscreteModel& model, const Eigen::VectorXd& initial_state,
                                   Eigen::Index samples, const Eigen::MatrixXd& directions,
                                   const Eigen::MatrixXd& inputs = {});

/// Cramer-Rao bound on the standard deviation of every entry of z_0: sqrt of the diagonal of I^-1 (n).
/// @throws std::invalid_argument when the information is singular: some combination is not determined.
/// filters/identifiability.hpp says which.
Eigen::VectorXd cramer_rao_bound(const Eigen::MatrixXd& information);

}  // namespace beamid::filters
