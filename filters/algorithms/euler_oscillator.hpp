// The damped oscillator of oscillator.hpp, moved by the explicit Euler step of the 2009 study [inverse2009]:
//
//     x+ = x + dt v,    v+ = v - dt (K x + C v) / M
#pragma once

#include "filters/algorithms/oscillator.hpp"

namespace beamid::filters::algorithms {

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

}  // namespace beamid::filters::algorithms
