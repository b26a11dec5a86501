// A model of which each lane sees some outputs only.
#pragma once

#include "filters/algorithms/scalar.hpp"

namespace beamid::filters::algorithms {

/// Outputs that were not measured become ones that see nothing, of expected value zero and of a noise of
/// their own, of variance one: they move nothing, and multiply the determinant of S by one.
template <class Model, class Scalar, int N, int P>
class SomeOutputs {
 public:
  /// Entries of y that are NaN were not measured; they are set to zero.
  SomeOutputs(Model& model, Vector<Scalar, P>& y) : model_(model), noise_(model.output_noise()) {
    for (int i = 0; i < P; ++i) {
      const auto measured = y[i] == y[i];  // NOLINT(misc-redundant-expression): not so of a NaN
      measured_[i] = select(measured, Scalar(1.0), Scalar(0.0));
      y[i] = select(measured, y[i], Scalar(0.0));
      for (int j = 0; j < P; ++j) {
        const Scalar own = i == j ? 1.0 : 0.0;
        noise_(i, j) = select(measured, noise_(i, j), own);
        noise_(j, i) = select(measured, noise_(j, i), own);
      }
    }
  }

  const Vector<Scalar, P>& measured() const { return measured_; }  ///< 1 where measured, else 0

  void output(const Vector<Scalar, N>& z, Vector<Scalar, P>& y) const {
    model_.output(z, y);
    y = y.cwiseProduct(measured_).eval();
  }
  void output_jacobian(const Vector<Scalar, N>& z, Matrix<Scalar, P, N>& jacobian) const {
    model_.output_jacobian(z, jacobian);
    for (int i = 0; i < P; ++i) jacobian.row(i) *= measured_[i];
  }
  const Matrix<Scalar, P>& output_noise() const { return noise_; }

 private:
  Model& model_;
  Vector<Scalar, P> measured_;
  Matrix<Scalar, P> noise_;
};

}  // namespace beamid::filters::algorithms
