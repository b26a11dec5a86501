// Frequency responses of a record to inputs that act all the time: a moving base, a shaker.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

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
