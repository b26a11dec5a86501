// Poles of frequency responses by a common-denominator model.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "experiments/modal/modal_method.hpp"

namespace beamid::experiments {

/// Least-squares complex frequency estimator [guillaume1998], [verboven2002]: over the lines,
///
///     sum_f |sum_j b_oj x^j - H_o(f) sum_j a_j x^j|^2 -> min,   x = e^(-i 2 pi f / (2 f_max)),   j = 0 .. n
///
/// for all outputs o with one denominator. The numerators are eliminated, a_n = 1 leaves real normal
/// equations of order n, and the orders share them. With the coefficient of the oldest value fixed, poles
/// that serve noise come out unstable and are left out by their damping ratio [cauberghe2004].
/// @param frequency_hz (F), rising, @param responses (p x F)
/// @param shift the lines are at s = i 2 pi f + shift: taken off the poles [1/s]
/// @return poles at the orders 2, 4, ...; shapes are the residues' (residue_fit.hpp)
/// @throws std::invalid_argument with fewer than largest_order + 2 lines.
std::vector<OrderPoles> common_denominator_poles(const Eigen::VectorXd& frequency_hz,
                                                 const Eigen::MatrixXcd& responses, double shift,
                                                 int largest_order);

/// The method that it makes. @param refusal what is said where no responses can be had
std::unique_ptr<ModalMethod> common_denominator_method(std::string refusal);

}  // namespace beamid::experiments
