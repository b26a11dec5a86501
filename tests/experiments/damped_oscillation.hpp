// One damped oscillation by its complex rate.
#pragma once

#include <Eigen/Core>
#include <complex>

namespace beamid::test {

/// 2 pi f (-zeta + i sqrt(1 - zeta^2)) [1/s].
std::complex<double> complex_rate(double frequency_hz, double damping_ratio);

/// Re(amplitude e^(rate (start + interval k))) for k = 0 ... count - 1.
Eigen::VectorXd damped_oscillation(std::complex<double> amplitude, std::complex<double> rate, double interval,
                                   Eigen::Index count, double start = 0.0);

}  // namespace beamid::test
