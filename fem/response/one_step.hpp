// The implicit one-step methods of structural dynamics, all of them members of one family.
#pragma once

#include <string>

#include "fem/response/method.hpp"

namespace beamid::fem {

/// Generalised-alpha method [chung1993]: with d = q, v = q', a = q'' at both ends of a step h,
///
///     d_1 = d + h v + h^2 ((1/2 - beta) a + beta a_1),      v_1 = v + h ((1 - gamma) a + gamma a_1),
///     M a_m + C v_f + K d_f + g(d_f, v_f) = f_f,            x_m = (1 - alpha_m) x_1 + alpha_m x, x_f
///     likewise.
///
/// alpha_m = alpha_f = 0 is Newmark's method, alpha_m = 0 alone is HHT-alpha.
struct OneStepScheme {
  std::string name;            ///< for messages
  double mass_average = 0.0;   ///< alpha_m
  double force_average = 0.0;  ///< alpha_f
  double beta = 0.25, gamma = 0.5;
};

/// The motion by such a scheme; damping by the law's proportional matrix and the dashpots of the model.
/// Elastic forces go through the strain factors. Cubic springs and quadratic dashpots are solved by Newton's
/// method for their forces alone, the factored matrix staying as it is.
/// @throws std::invalid_argument for a law without a sparse matrix; std::runtime_error when Newton's method
/// does not converge, naming the time.
Response integrate(const ResponseProblem& problem, const OneStepScheme& scheme);

}  // namespace beamid::fem
