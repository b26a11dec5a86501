#include "fem/free_decay.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <string>

namespace beamid::fem {
namespace {

using Eigen::ArrayXcd, Eigen::Index;
using Complex = std::complex<double>;

// The interval of evenly spaced instants, to what rounding leaves of them; 0 when they are not.
double even_interval(const Eigen::VectorXd& time) {
  const Index count = time.size();
  if (count < 2) return 0.0;
  const double interval = (time[count - 1] - time[0]) / static_cast<double>(count - 1);
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * time.cwiseAbs().maxCoeff();
  for (Index k = 0; k < count; ++k)
    if (!(std::abs(time[k] - (time[0] + static_cast<double>(k) * interval)) <= rounding)) return 0.0;
  return interval;
}

// Motion += Re(c e^(lambda t)) and its derivatives. Over even instants the exponentials of a stretch are
// those of the first stretch times one number: no rounding adds up from sample to sample.
void add_decay(Complex c, Complex lambda, const Eigen::VectorXd& time, double interval, Motion& motion) {
  constexpr Index stretch = 64;
  const Index length = interval > 0.0 ? std::min(stretch, time.size()) : 1;
  ArrayXcd turns(length);
  for (Index j = 0; j < length; ++j) turns[j] = std::exp(lambda * (static_cast<double>(j) * interval));
  const Eigen::ArrayXd re = turns.real(), im = turns.imag();
  for (Index first = 0; first < time.size(); first += length) {
    const Index count = std::min(length, time.size() - first);
    Complex x = c * std::exp(lambda * time[first]);
    for (Eigen::VectorXd* history : {&motion.displacement, &motion.velocity, &motion.acceleration}) {
      history->segment(first, count).array() += x.real() * re.head(count) - x.imag() * im.head(count);
      x *= lambda;
    }
  }
}

}  // namespace

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
  const double interval = even_interval(time);
  motion.displacement.setZero(time.size());
  motion.velocity.setZero(time.size());
  motion.acceleration.setZero(time.size());
  for (Eigen::Index i = 0; i < amplitude.size(); ++i) {
    const double xi = damping_ratio[i], omega = angular_frequency[i];
    if (!(xi >= 0.0 && xi < 1.0))
      throw std::invalid_argument("free decay: damping ratio " + std::to_string(xi) +
                                  "; expected 0 <= xi < 1");
    // x = Re(c e^(lambda t)), with x(0) = a and x'(0) = 0
    const Complex lambda(-xi * omega, omega * std::sqrt(1.0 - xi * xi));
    const Complex c(amplitude[i], amplitude[i] * lambda.real() / lambda.imag());
    add_decay(c, lambda, time, interval, motion);
  }
  return motion;
}

}  // namespace beamid::fem
