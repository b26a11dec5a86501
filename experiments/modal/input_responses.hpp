// Frequency responses of a record to inputs that act all the time: a moving base, a shaker.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/modal_method.hpp"

namespace beamid::experiments {

// Poles of frequency responses by a common-denominator model.

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

/// Responses of p channels to m inputs at F lines.
struct InputResponses {
  Eigen::VectorXd frequency_hz;  ///< (F)
  Eigen::MatrixXcd h1;        ///< (p m x F), channel i to input j in row i + p j [unit / unit of the input]
  Eigen::MatrixXd coherence;  ///< (p x F) multiple coherence, 0 to 1
  int averages = 0;           ///< blocks, which overlap by three quarters
  double duration = 0.0;      ///< of a block [s]
};

/// H1 = S_yu S_uu^-1 over blocks under a Hann window; the coherence is what H1 u has of the power of y
/// [bendat2010, ch. 7]. A block is 2 / (b + 1) of the record, b = 6 m: long enough for resonances to be seen,
/// short enough for an average. A fit of the lines themselves (driven_poles.hpp) has to follow.
/// @param outputs (p x N), @param inputs (m x N)
/// @throws std::invalid_argument with fewer than 64 samples a block.
InputResponses input_responses(const Eigen::MatrixXd& outputs, const Eigen::MatrixXd& inputs,
                               double interval);

}  // namespace beamid::experiments
