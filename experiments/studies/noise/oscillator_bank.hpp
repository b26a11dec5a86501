// Decaying oscillators that one sensor sees the sum of; of the first few, frequency and damping are unknown.
#pragma once

#include <vector>

#include "experiments/record/record.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

/// Per unit of mass: x'' + c x' + k x = w.
struct BankMember {
  double stiffness = 0.0;  ///< k = omega^2 [1/s2]
  double damping = 0.0;    ///< c = 2 xi omega [1/s]
  bool unknown = false;    ///< k and c are states; these come first
  /// Stationary standard deviation [m] of x under the white noise w: a shaping filter of coloured noise. The
  /// noise of one step is P - F P F^T with P = s^2 diag(1, k), exactly. 0: no w.
  double shaped = 0.0;
};

/// State [x1, v1, ..., xr, vr, k1, c1, ..., ku, cu]; output the sum of all x, of all v or of all v'. Each
/// pair moves by its own matrix exponential, in closed form.
/// @param variance R of the sensor
/// @throws std::invalid_argument when a member does not oscillate, or an unknown one follows a known one
std::unique_ptr<filters::DiscreteModel> oscillator_bank(const std::vector<BankMember>& members,
                                                        Quantity observed, double interval, double variance);

}  // namespace beamid::experiments
