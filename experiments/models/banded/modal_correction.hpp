// Damping of single modes in a sparse system: a term of low rank.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/models/banded/step_factor.hpp"
#include "experiments/models/motion/parametric_motion.hpp"

namespace beamid::experiments::banded {

/// With S_b, K + lambda C + lambda^2 M without them, k damped modes and G = [g_1 ... g_k] (n x k) the inverse
/// is [woodbury1950]
///
///     (S_b + lambda G c G^T)^-1 b = y - Z (I + lambda c G^T Z)^-1 lambda c G^T y,
///     y = S_b^-1 b,   Z = S_b^-1 G,
///
/// c being diagonal. In this form modes may be without damping.
class ModalCorrection {
 public:
  explicit ModalCorrection(Eigen::Index size) : size_(size), zeros_(size), lanes_(size), block_(size) {}

  /// Z and the k x k system; b (n), a right side, goes through the factor beside G and comes out
  /// solved, correction included.
  void factor(const StepFactor& factored, const std::vector<ModeDamping>& modes, const Complex& lambda,
              Complex* b);

  /// y (n), of the same modes, corrected in place; likewise four columns.
  void operator()(const std::vector<ModeDamping>& modes, Complex* y) const;
  void operator()(const std::vector<ModeDamping>& modes, ComplexLanes* y) const;

 private:
  template <class Real>
  void correct(const std::vector<ModeDamping>& modes, ComplexOf<Real>* b) const;
  /// G^T b
  template <class Real>
  std::vector<ComplexOf<Real>> overlaps_of(const std::vector<ModeDamping>& modes,
                                           const ComplexOf<Real>* b) const;
  template <class Real>
  void take_response_off(const ComplexOf<Real>* seen, ComplexOf<Real>* b) const;  ///< `seen`: G^T y

  Eigen::Index size_;
  std::vector<std::vector<Complex>> responses_;  // Z (k of n)
  std::vector<Complex> coupling_;                // (I + lambda c G^T Z)^-1 lambda c (k x k)
  std::vector<double> zeros_;
  std::vector<Lanes> lanes_;
  std::vector<ComplexLanes> block_;
};

/// g^T x of vectors (n).
Complex inner(const double* g, const Complex* x, Eigen::Index size);

}  // namespace beamid::experiments::banded
