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
  /// @tparam moving where it is less than N, rows of J from there on are those of the identity: only so many
  /// rows and columns of C change, and nothing is lost but products by zero and one
  template <int moving = N>
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
    if constexpr (moving < N) {
      constexpr int held = N - moving;
      const Matrix<Scalar, moving, N> rows = tangent.template topRows<moving>();
      Matrix<Scalar, moving, N> carried;
      Matrix<Scalar, moving> corner;
      multiply(rows, covariance, carried);
      multiply_transposed(carried, rows, corner);
      covariance.template topLeftCorner<moving, moving>() = corner;
      covariance.template topRightCorner<moving, held>() = carried.template rightCols<held>();
      covariance.template bottomLeftCorner<held, moving>() = carried.template rightCols<held>().transpose();
      return;
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
