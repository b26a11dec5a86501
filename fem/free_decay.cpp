#include "fem/free_decay.hpp"

#include <complex>
#include <stdexcept>
#include <string>

namespace beamid::fem {

Eigen::VectorXd modal_amplitudes(const StructuralSystem& system, const Modes& modes,
                                 const Eigen::VectorXd& initial_displacement, Eigen::Index output) {
  const Eigen::VectorXd modal = modes.shape.transpose() * (system.mass * initial_displacement);
  const Eigen::MatrixXd seen = system.outputs * modes.shape;
  return seen.row(output).transpose().cwiseProduct(modal);
}

Motion free_decay(const Eigen::VectorXd& amplitude, const Eigen::VectorXd& angular_frequency,
                  const Eigen::VectorXd& damping_ratio, const Eigen::VectorXd& time) {
  if (amplitude.size() != angular_frequency.size() || amplitude.size() != damping_ratio.size())
    throw std::invalid_argument("free decay: " + std::to_string(amplitude.size()) + " amplitudes, " +
                                std::to_string(angular_frequency.size()) + " frequencies and " +
                                std::to_string(damping_ratio.size()) +
                                " damping ratios; expected as many of each");
  Motion motion;
  motion.displacement.setZero(time.size());
  motion.velocity.setZero(time.size());
  motion.acceleration.setZero(time.size());
  for (Eigen::Index i = 0; i < amplitude.size(); ++i) {
    const double xi = damping_ratio[i], omega = angular_frequency[i];
    if (!(xi >= 0.0 && xi < 1.0))
      throw std::invalid_argument("free decay: damping ratio " + std::to_string(xi) +
                                  "; expected 0 <= xi < 1");
    // x = Re(c e^(lambda t)), with x(0) = a and x'(0) = 0
    const std::complex<double> lambda(-xi * omega, omega * std::sqrt(1.0 - xi * xi));
    const std::complex<double> c(amplitude[i], amplitude[i] * lambda.real() / lambda.imag());
    for (Eigen::Index k = 0; k < time.size(); ++k) {
      const std::complex<double> x = c * std::exp(lambda * time[k]);
      motion.displacement[k] += x.real();
      motion.velocity[k] += (lambda * x).real();
      motion.acceleration[k] += (lambda * lambda * x).real();
    }
  }
  return motion;
}

}  // namespace beamid::fem
