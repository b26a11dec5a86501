// The two steps of a covariance under a linearised model.
#pragma once

#include <type_traits>

#include "filters/algorithms/products.hpp"
#include "filters/nonzeros.hpp"

namespace beamid::filters::algorithms {

/// Work space of a covariance of N states seen through P outputs.
template <class Scalar, int N, int P>
class CovarianceSteps {
 public:
  /// C becomes J C J^T, in its lower triangle and, but for rounding, above.
  void carry(const Matrix<Scalar, N>& tangent, Matrix<Scalar, N>& covariance) {
    if constexpr (N == Eigen::Dynamic) {
      if (tangent.rows() > small && entries_.take(tangent)) {
        entries_.from_right(covariance, work_);
        covariance = work_.transpose();  // J C, as C is symmetric
        entries_.from_right(covariance, work_);
        covariance.swap(work_);
        return;
      }
    }
    multiply(tangent, covariance, work_);
    multiply_transposed(work_, tangent, covariance);
  }

  /// C becomes (I - G H) C (I - G H)^T + G R G^T, symmetric: Joseph's form [bucy1968], positive for any gain,
  /// so that the gain's rounding costs its square. Of two updates of rank p,
  ///
  ///     W = C - G (H C),    C = W - (W H^T - G R) G^T,
  ///
  /// whose second is 0 for the best gain without rounding. Products with I - G H, which is never formed, are
  /// n^2 p instead of n^3.
  void reduce(const Matrix<Scalar, N, P>& gain, const Matrix<Scalar, P, N>& sensor,
              const Matrix<Scalar, P>& noise, Matrix<Scalar, N>& covariance) {
    multiply_transposed(covariance, sensor, shown_);
    minus_gain_ = -gain;
    multiply_transposed<Into::old_sum>(minus_gain_, shown_, covariance);
    multiply_transposed(covariance, sensor, shown_);
    multiply<Form::plain, Into::old_sum>(minus_gain_, noise, shown_);
    multiply_transposed<Into::old_sum>(shown_, minus_gain_, covariance);
    mirror(covariance);
  }

 private:
  static constexpr Eigen::Index small = 16;  // up to here dense products are as fast
  Matrix<Scalar, N> work_;
  Matrix<Scalar, N, P> minus_gain_, shown_;
  struct None {};
  [[no_unique_address]] std::conditional_t<N == Eigen::Dynamic, NonZeros, None> entries_;
};

}  // namespace beamid::filters::algorithms
