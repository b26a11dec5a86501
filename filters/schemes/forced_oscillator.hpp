// What inputs add to two coordinates over a step.
#pragma once

#include <Eigen/Core>

#include "filters/step_input.hpp"

namespace beamid::filters {

/// v = integral_0^1 e^(Z (1 - s)) g(s) ds,   g(s) = sum_j g_j s^j, and its derivative along Z', g'.
///
/// Where |Z| is small, v = sum_k Z^k h_k with h_k = sum_j j! / (k + j + 1)! g_j. Else from the polynomial
/// motion x = sum_j a_j s^j under g, Z a_j = (j + 1) a_(j+1) - g_j:   v = x(1) - e^Z x(0).
class ForcedOscillator {
 public:
  /// g_0 .. g_d in columns (2 x (d + 1)).
  using Pushes = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, StepInput::highest_degree + 1>;

  /// Whether one of both ways keeps its digits: not of motion that is fast and damped far above critical.
  static bool takes(const Eigen::Matrix2d& z);

  /// @param exponential e^Z
  ForcedOscillator(const Eigen::Matrix2d& z, const Eigen::Matrix2d& exponential, const Pushes& pushes);

  const Eigen::Vector2d& value() const { return value_; }
  /// @param turn Z'; @param exponential_slope (e^Z)'; @param slopes g'
  Eigen::Vector2d derivative(const Eigen::Matrix2d& turn, const Eigen::Matrix2d& exponential_slope,
                             const Pushes& slopes) const;

 private:
  static constexpr int most_terms = 32;
  using Terms = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, most_terms>;

  Terms terms(const Pushes& pushes) const;

  Eigen::Matrix2d z_, exponential_, inverse_;
  Eigen::Index count_ = 0;  // of terms; 0: by the polynomial motion
  Terms terms_;             // h_k, or a_j
  Eigen::Vector2d value_;
};

}  // namespace beamid::filters
