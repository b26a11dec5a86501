#include "experiments/studies/noise/modal_record.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "fem/assembly.hpp"
#include "fem/free_decay.hpp"
#include "fem/stiffness_solver.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

int derivatives(Quantity observed) {
  return observed == Quantity::displacement ? 0 : observed == Quantity::velocity ? 1 : 2;
}

// Spectrum of a half sine of duration T at w, relative to that at 0: cos(w T/2) / (1 - (w T/pi)^2).
double half_sine(double w, double duration) {
  const double u = w * duration / std::numbers::pi;
  return std::abs(u - 1.0) < 1e-6 ? 0.25 * std::numbers::pi
                                  : std::cos(0.5 * std::numbers::pi * u) / (1.0 - u * u);
}

}  // namespace

double ModalMotion::size(Index i, Quantity observed) const {
  return std::abs(amplitude[i]) * std::pow(std::abs(rate[i]), derivatives(observed));
}

ModalMotion modal_motion(const fem::Beam& beam, int elements, const VectorXd& damping_ratios, Blow blow,
                         double deflection, double blow_duration) {
  const fem::StructuralSystem system = fem::assemble(beam, elements);
  const fem::Modes modes = fem::modes(system, damping_ratios.size());
  const VectorXd released = fem::modal_amplitudes(system, modes, fem::static_shape(system));
  ModalMotion motion{Eigen::VectorXcd(modes.size()), Eigen::VectorXcd(modes.size())};
  const auto blown = [&](Index i) {  // displacement that a unit of momentum gives mode i
    const double at_point = (system.outputs.row(0) * modes.shape.col(i))(0), w = modes.angular_frequency[i];
    return at_point * at_point / w * half_sine(w, blow_duration);
  };
  for (Index i = 0; i < modes.size(); ++i) {
    const double w = modes.angular_frequency[i], xi = damping_ratios[i], turn = std::sqrt(1.0 - xi * xi);
    motion.rate[i] = {-xi * w, w * turn};
    // Re a = x(0) and Re(a lambda) = v(0): from rest, or from x = 0 with v = w x(peak).
    motion.amplitude[i] =
        deflection * (blow == Blow::release ? released[i] / released[0] * std::complex(1.0, -xi / turn)
                                            : blown(i) / blown(0) * std::complex(0.0, -1.0 / turn));
  }
  return motion;
}

ModalRecord modal_record(const ModalMotion& motion, Quantity observed, double interval, double duration,
                         double noise, std::uint64_t seed, std::uint64_t stream) {
  filters::RandomStream random(seed, stream);
  const auto count = static_cast<Index>(std::lround(duration / interval)) + 1;
  ModalRecord record{interval, VectorXd::Zero(count), VectorXd::Zero(count), 0.0};
  record.start = random.uniform() * 2.0 * std::numbers::pi / motion.rate[0].imag();
  for (Index i = 0; i < motion.rate.size(); ++i) {
    const std::complex<double> rate = motion.rate[i],
                               a = motion.amplitude[i] * std::pow(rate, derivatives(observed));
    for (Index k = 0; k < count; ++k) {
      const double value = (a * std::exp(rate * (record.start + static_cast<double>(k) * interval))).real();
      record.samples[k] += value;
      if (i > 0) record.higher[k] += value;
    }
  }
  record.samples += noise * random.normal(count, 1).col(0);
  return record;
}

}  // namespace beamid::experiments
