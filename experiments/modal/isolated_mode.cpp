#include "experiments/modal/isolated_mode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd, Eigen::VectorXcd;

constexpr double fewest_kernels = 1.5;
constexpr Index fewest_values = 5;

/// How many values come before the first that is smaller than this.
Index reach(const VectorXcd& values, double least) {
  Index count = 0;
  while (count < values.size() && std::abs(values[count]) >= least) ++count;
  return std::max(count, std::min(fewest_values, values.size()));
}

/// The mode over the first `count` values.
void take(const VectorXcd& values, Index count, IsolatedMode& mode) {
  mode.values = values.head(count);
  mode.logarithm = unwrapped_logarithm(mode.values);
  const VectorXd time = mode.interval * VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  mode.line = line_through(time, mode.logarithm, mode.independent());
  const Complex mean =
      Complex(mode.line.log_amplitude,
              (mode.values.cwiseAbs2().array() *
               (mode.logarithm.imag().array() - mode.line.slope.imag() * (time.array() - mode.line.time)))
                      .sum() /
                  mode.values.squaredNorm());
  const VectorXcd model = (mean + mode.line.slope * (time.array() - mode.line.time).cast<Complex>()).exp();
  const double independent = std::max(static_cast<double>(count) * mode.independent(), 2.5);
  mode.noise = std::sqrt((mode.values - model).squaredNorm() / static_cast<double>(count) * independent /
                         (independent - 2));
}

}  // namespace

IsolatedMode isolate(const VectorXd& signal, double interval, double frequency_hz,
                     const std::vector<Complex>& others) {
  IsolatedMode mode;
  Complex rate(0, 2 * std::numbers::pi * frequency_hz);
  std::vector<Complex> neighbours = others;
  std::erase_if(neighbours, [&](const Complex& other) { return other.imag() == rate.imag(); });
  for (int pass = 0; pass < 2; ++pass) {  // the kernel's gain and w are those of the rate found at first
    const Demodulated found = demodulate(signal, interval, rate, neighbours, fewest_kernels);
    if (found.values.size() < fewest_values)
      throw std::invalid_argument(fmt::format("{} values of the mode at {:.4g} Hz; expected {} at least",
                                              found.values.size(), frequency_hz, fewest_values));
    mode.turned_back = rate.imag();
    mode.interval = found.interval;
    mode.correlation = found.correlation;
    const double largest = found.values.cwiseAbs().maxCoeff();
    take(found.values, reach(found.values, 0.2 * largest), mode);
    take(found.values, reach(found.values, std::max(5 * mode.noise, 0.01 * largest)), mode);
    if (pass == 0 && std::abs(mode.line.slope.imag()) < 0.1 * rate.imag()) rate = mode.rate();
  }
  return mode;
}

}  // namespace beamid::experiments
