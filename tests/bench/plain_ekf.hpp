// The yardstick of filters_bench: an extended Kalman filter as anybody would write it by hand with Eigen's
// matrices of fixed size. Joint identification of [x v K C], RK4 for the state and its tangent, Joseph's
// update.
#pragma once

#include <Eigen/Dense>

namespace beamid::bench {

struct PlainEkf {
  using State = Eigen::Vector4d;
  using Square = Eigen::Matrix4d;

  double mass, dt;
  Square process;
  Eigen::Matrix2d noise;
  State mean;
  Square covariance;
  Eigen::Matrix<double, 2, 4> sensor = Eigen::Matrix<double, 2, 4>::Identity();

  State rate(const State& z) const { return {z[1], -(z[2] * z[0] + z[3] * z[1]) / mass, 0.0, 0.0}; }
  Square rate_jacobian(const State& z) const {
    Square j;
    j << 0.0, 1.0, 0.0, 0.0,  //
        -z[2] / mass, -z[3] / mass, -z[0] / mass, -z[1] / mass, Square::Zero().bottomRows<2>();
    return j;
  }

  void predict() {
    const Square identity = Square::Identity();
    const State k1 = rate(mean), z2 = mean + 0.5 * dt * k1;
    const State k2 = rate(z2), z3 = mean + 0.5 * dt * k2;
    const State k3 = rate(z3), z4 = mean + dt * k3;
    const State k4 = rate(z4);
    const Square j1 = rate_jacobian(mean);
    const Square j2 = rate_jacobian(z2) * (identity + 0.5 * dt * j1);
    const Square j3 = rate_jacobian(z3) * (identity + 0.5 * dt * j2);
    const Square j4 = rate_jacobian(z4) * (identity + dt * j3);
    mean += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    const Square tangent = identity + dt / 6.0 * (j1 + 2.0 * j2 + 2.0 * j3 + j4);
    covariance = tangent * covariance * tangent.transpose() + process;
  }

  void correct(const Eigen::Vector2d& y) {
    const Eigen::Vector2d innovation = y - sensor * mean;
    const Eigen::Matrix2d s = sensor * covariance * sensor.transpose() + noise;
    const Eigen::Matrix<double, 4, 2> gain = covariance * sensor.transpose() * s.inverse();
    mean += gain * innovation;
    const Square kept = Square::Identity() - gain * sensor;
    covariance = kept * covariance * kept.transpose() + gain * noise * gain.transpose();
  }
};

}  // namespace beamid::bench
