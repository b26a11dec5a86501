#include "tests/experiments/modal/struck_modes.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/signal/toolbox.hpp"

namespace beamid::test {
namespace {

using Complex = std::complex<double>;
using experiments::Record, experiments::Quantity;

struct Exponential {
  Complex factor, rate;
};

std::vector<Exponential> exponentials(const Impact& impact) {
  const double turn = std::numbers::pi / impact.duration;
  if (impact.half_sine)
    return {{Complex(0, -0.5) * impact.peak, Complex(0, turn)},
            {Complex(0, 0.5) * impact.peak, Complex(0, -turn)}};
  return {{0.5 * impact.peak, 0},
          {-0.25 * impact.peak, Complex(0, 2 * turn)},
          {-0.25 * impact.peak, Complex(0, -2 * turn)}};
}

}  // namespace

Record struck_modes(const std::vector<StruckMode>& modes, const std::vector<Impact>& impacts, double interval,
                    Eigen::Index count) {
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(count, 0, interval * static_cast<double>(count - 1));
  record.channels = {{Quantity::force, "hammer"}, {Quantity::acceleration, "tip"}};
  record.samples = Eigen::MatrixXd::Zero(2, count);
  for (const Impact& impact : impacts)
    for (Eigen::Index k = 0; k < count; ++k) {
      const double after = record.time[k] - impact.start, during = std::min(after, impact.duration);
      if (after <= 0) continue;
      double force = 0;
      for (const Exponential& part : exponentials(impact))
        if (after < impact.duration) force += (part.factor * std::exp(part.rate * after)).real();
      record.samples(0, k) += force;
      for (const StruckMode& mode : modes) {
        const double w = 2 * std::numbers::pi * mode.frequency_hz;
        const Complex p = w * Complex(-mode.ratio, std::sqrt(1 - mode.ratio * mode.ratio));
        Complex z = 0;
        for (const Exponential& part : exponentials(impact))
          z += part.factor * (std::exp(part.rate * during) - std::exp(p * during)) / (part.rate - p);
        record.samples(1, k) +=
            (force + (p * p * z * std::exp(p * (after - during))).imag() / p.imag()) / mode.mass;
      }
    }
  return record;
}

Record with_noise(Record record, double force_n, double acceleration, std::uint64_t seed) {
  const Eigen::Index count = record.size();
  record.samples.row(0) += force_n * experiments::standard_normal(count, seed, 1).transpose();
  record.samples.row(1) += acceleration * experiments::standard_normal(count, seed, 2).transpose();
  return record;
}

}  // namespace beamid::test
