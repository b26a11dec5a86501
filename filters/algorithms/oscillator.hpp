// The damped oscillator with unknown stiffness and damping, moved exactly.
//
//     M x'' + C x' + K x = 0,   state z = [x, v, K, C],   M known
//
// With delta = C dt / (2M), k = K dt / M, z = delta^2 - k dt and p, q, r = e^-delta (c, s, s')(z)
// (entire_functions.hpp), under-, critically and over-damped alike:
//
//     x+ = (p + q delta) x + q dt v,    v+ = -q k x + (p - q delta) v
//
// and, with dp/dz = q/2, dq/dz = r, dp/d delta = -p, dq/d delta = -q, the derivatives by K and by C.
#pragma once

#include <array>

#include "filters/algorithms/cholesky.hpp"
#include "filters/algorithms/entire_functions.hpp"
#include "filters/algorithms/lanes.hpp"
#include "filters/algorithms/quantity.hpp"
#include "filters/algorithms/scalar.hpp"

namespace beamid::filters::algorithms {

/// A model of N = 4 states and P outputs, as registered_filter.hpp describes them.
template <class Scalar, int P>
class Oscillator {
 public:
  static constexpr int states = 4;
  static constexpr int moving = 2;  ///< the others are constants
  using State = Vector<Scalar, 4>;

  /// @param mass M [kg]. @param interval dt [s]. @param process_noise Q per step. @param output_noise R.
  Oscillator(double mass, double interval, const std::array<Quantity, P>& observed,
             const Matrix<Scalar, 4>& process_noise, const Matrix<Scalar, P>& output_noise)
      : step_(interval),
        per_mass_(1.0 / mass),
        observed_(observed),
        process_noise_(process_noise),
        output_noise_(output_noise) {
    lower_root(process_noise_, process_noise_root_);
    lower_root(output_noise_, output_noise_root_);
  }

  void transition(const State& z, State& next) const {
    const Motion<Scalar> m = motion(z[2], z[3]);
    next << m.xx * z[0] + m.xv * z[1], m.vx * z[0] + m.vv * z[1], z[2], z[3];
  }

  /// F at every column of `points`.
  template <class Points>
  void transitions(const Points& points, Points& moved) const {
    if constexpr (std::is_same_v<Scalar, double>) {
      using Pair = Lanes<2, Baseline>;
      for (Eigen::Index i = 0; i < points.cols(); i += 2) {
        const Eigen::Index j = i + 1 < points.cols() ? i + 1 : i;
        const auto both = [&](int row) {
          return Pair(typename Pair::Values{points(row, i), points(row, j)});
        };
        const Motion<Pair> m = motion(both(2), both(3));
        const Pair x = both(0), v = both(1), next_x = m.xx * x + m.xv * v, next_v = m.vx * x + m.vv * v;
        moved.col(i) << next_x[0], next_v[0], points(2, i), points(3, i);
        moved.col(j) << next_x[1], next_v[1], points(2, j), points(3, j);
      }
    } else {
      State next;
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        transition(points.col(i), next);
        moved.col(i) = next;
      }
    }
  }

  /// F(z) and J = dF/dz (4 x 4).
  void linearised_transition(const State& z, State& next, Matrix<Scalar, 4>& jacobian) const {
    const Motion<Scalar> m = motion(z[2], z[3]);
    const Scalar x = z[0], v = z[1];
    next << m.xx * x + m.xv * v, m.vx * x + m.vv * v, z[2], z[3];
    const double k_slope = step_ * per_mass_, delta_slope = 0.5 * k_slope;  // dk/dK, d delta/dC
    const double z_by_k = -k_slope * step_;                                 // dz/dK
    const Scalar z_by_c = 2.0 * delta_slope * m.delta;                      // dz/dC
    const Scalar half = 0.5 * m.q, turn = m.r * m.delta;
    const Scalar x_by_z = (half + turn) * x + m.r * step_ * v, v_by_z = (half - turn) * v - m.r * m.k * x;
    jacobian.setIdentity();
    jacobian(0, 0) = m.xx, jacobian(0, 1) = m.xv;
    jacobian(1, 0) = m.vx, jacobian(1, 1) = m.vv;
    jacobian(0, 2) = z_by_k * x_by_z;
    jacobian(1, 2) = z_by_k * v_by_z - k_slope * m.q * x;
    jacobian(0, 3) = z_by_c * x_by_z + delta_slope * (m.q * x - next[0]);
    jacobian(1, 3) = z_by_c * v_by_z - delta_slope * (m.q * v + next[1]);
  }

  void output(const State& z, Vector<Scalar, P>& y) const { outputs(z, y); }

  /// h at every column of `points`.
  template <class Points, class Values>
  void outputs(const Points& points, Values& values) const {
    for (int i = 0; i < P; ++i)
      if (observed_[i] == Quantity::displacement)
        values.row(i) = points.row(0);
      else if (observed_[i] == Quantity::velocity)
        values.row(i) = points.row(1);
      else
        values.row(i) = -per_mass_ * (points.row(2).cwiseProduct(points.row(0)) +
                                      points.row(3).cwiseProduct(points.row(1)));
  }

  /// H = dh/dz (P x 4).
  void output_jacobian(const State& z, Matrix<Scalar, P, 4>& h) const {
    for (int i = 0; i < P; ++i)
      if (observed_[i] == Quantity::displacement)
        h.row(i) << 1.0, 0.0, 0.0, 0.0;
      else if (observed_[i] == Quantity::velocity)
        h.row(i) << 0.0, 1.0, 0.0, 0.0;
      else
        h.row(i) << -per_mass_ * z[2], -per_mass_ * z[3], -per_mass_ * z[0], -per_mass_ * z[1];
  }

  const Matrix<Scalar, 4>& process_noise() const { return process_noise_; }
  const Matrix<Scalar, P>& output_noise() const { return output_noise_; }
  const Matrix<Scalar, 4>& process_noise_root() const { return process_noise_root_; }
  const Matrix<Scalar, P>& output_noise_root() const { return output_noise_root_; }

 protected:
  double step() const { return step_; }
  double per_mass() const { return per_mass_; }

 private:
  template <class Number>
  struct Motion {
    Number xx, xv, vx, vv;  // e^(A dt)
    Number q, r, delta, k;
  };
  template <class Number>
  [[gnu::always_inline]] Motion<Number> motion(const Number& stiffness, const Number& damping) const {
    const Number delta = (0.5 * step_ * per_mass_) * damping, k = (step_ * per_mass_) * stiffness;
    const auto [p, q, r] = damped_entire_functions<Number>(delta * delta - k * step_, delta);
    return {p + q * delta, q * step_, -q * k, p - q * delta, q, r, delta, k};
  }

  double step_, per_mass_;
  std::array<Quantity, P> observed_;
  Matrix<Scalar, 4> process_noise_, process_noise_root_;
  Matrix<Scalar, P> output_noise_, output_noise_root_;
};

// The damped oscillator of oscillator.hpp, moved by the explicit Euler step of the 2009 study [inverse2009]:
//
//     x+ = x + dt v,    v+ = v - dt (K x + C v) / M

template <class Scalar, int P>
class EulerOscillator : public Oscillator<Scalar, P> {
 public:
  using State = Vector<Scalar, 4>;
  using Oscillator<Scalar, P>::Oscillator;

  /// F(z) and J = dF/dz (4 x 4).
  void linearised_transition(const State& z, State& next, Matrix<Scalar, 4>& jacobian) const {
    const double dt = this->step(), share = dt * this->per_mass();
    const Scalar x = z[0], v = z[1];
    next << x + dt * v, v - share * (z[2] * x + z[3] * v), z[2], z[3];
    jacobian.setIdentity();
    jacobian(0, 1) = dt;
    jacobian(1, 0) = -share * z[2];
    jacobian(1, 1) = 1.0 - share * z[3];
    jacobian(1, 2) = -share * x;
    jacobian(1, 3) = -share * v;
  }
};

// One mode as any sensor shows it, its stiffness and damping ratio relative to what they are expected to be:
//
//     y'' + 2 xi w y' + w^2 y = 0,   w^2 = w_0^2 e^k,   state [y, y', k, xi, o],   observed: y + o
//
// Moved as the oscillator of M = 1, K = w^2 and C = 2 xi w, whose derivatives give those by k and by xi:
//
//     d/dk = w^2 d/dK + xi w d/dC,    d/dxi = 2 w d/dC

/// A model of 5 states and one output.
template <class Scalar>
class RingingOscillator {
 public:
  static constexpr int states = 5;
  static constexpr int moving = 2;
  using State = Vector<Scalar, 5>;

  /// @param w0 [rad/s] @param interval [s] @param process_noise Q per step @param output_noise R
  RingingOscillator(double w0, double interval, const Matrix<Scalar, 5>& process_noise,
                    const Matrix<Scalar, 1>& output_noise)
      : w0_(w0),
        process_noise_(process_noise),
        output_noise_(output_noise),
        oscillator_(1.0, interval, {Quantity::displacement}, Matrix<Scalar, 4>::Constant(Scalar(0.0)),
                    output_noise) {}

  void transition(const State& z, State& next) const {
    Vector<Scalar, 4> moved;
    oscillator_.transition(oscillator_state(z, frequency(z)), moved);
    next << moved[0], moved[1], z[2], z[3], z[4];
  }

  /// F(z) and J = dF/dz (5 x 5).
  void linearised_transition(const State& z, State& next, Matrix<Scalar, 5>& jacobian) const {
    const Scalar w = frequency(z), w2 = w * w, xi_w = z[3] * w;
    Vector<Scalar, 4> moved;
    Matrix<Scalar, 4> slopes;
    oscillator_.linearised_transition(oscillator_state(z, w), moved, slopes);
    next << moved[0], moved[1], z[2], z[3], z[4];
    jacobian.setIdentity();
    for (int i = 0; i < 2; ++i) {
      jacobian(i, 0) = slopes(i, 0), jacobian(i, 1) = slopes(i, 1);
      jacobian(i, 2) = w2 * slopes(i, 2) + xi_w * slopes(i, 3);
      jacobian(i, 3) = 2.0 * w * slopes(i, 3);
    }
  }

  void output(const State& z, Vector<Scalar, 1>& y) const { y[0] = z[0] + z[4]; }
  void output_jacobian(const State&, Matrix<Scalar, 1, 5>& h) const { h << 1.0, 0.0, 0.0, 0.0, 1.0; }

  const Matrix<Scalar, 5>& process_noise() const { return process_noise_; }
  const Matrix<Scalar, 1>& output_noise() const { return output_noise_; }

 private:
  Scalar frequency(const State& z) const { return w0_ * exponential<Scalar>(0.5 * z[2]); }
  static Vector<Scalar, 4> oscillator_state(const State& z, const Scalar& w) {
    return {z[0], z[1], w * w, 2.0 * z[3] * w};
  }

  double w0_;
  Matrix<Scalar, 5> process_noise_;
  Matrix<Scalar, 1> output_noise_;
  Oscillator<Scalar, 1> oscillator_;
};

// A model of which each lane sees some outputs only.

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
