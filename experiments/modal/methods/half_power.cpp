// Half-power width of each mode's spectrum [ewins2000], the bias of the finite record taken off.
#include "experiments/modal/classic_estimators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/modal/mode_by_mode.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXcd;

/// An exponential window e^(-a t), with (d + a) T = `decay`, widens the peak by a that is known and makes the
/// width depend on d in the first order, where under a rectangular one it does so only in the second as
/// d T -> 0. What the end of the window leaves is taken off in closed form (damping_rate_of_distance).
class HalfPower final : public ModeByModeMethod {
 public:
  explicit HalfPower(double decay) : decay_(decay) {}

 private:
  ModeAnswer estimate(const IsolatedMode& mode) const override {
    const Index count = mode.values.size();
    const double length = mode.interval * static_cast<double>(count);
    const double guess = std::max(-mode.line.slope.real(), 0.0),
                 added = std::max(0.0, decay_ / length - guess);
    VectorXcd window(count), values = mode.values;
    for (Index m = 0; m < count; ++m) {
      window[m] = std::exp(-added * mode.interval * static_cast<double>(m));
      values[m] *=
          window[m] * std::polar(1.0, -mode.line.slope.imag() * mode.interval * static_cast<double>(m));
    }
    const double scale = half_power_distance(guess + added, count, mode.interval);
    const HalfPowerPoints points = half_power_points(values, mode.interval, scale);
    const double widened = damping_rate_of_distance(points.distance(), count, mode.interval);
    if (!(widened > added))
      throw std::invalid_argument(fmt::format("the width of the peak, {:.3g} Hz, is that of the window alone",
                                              points.distance() / std::numbers::pi));
    const double step = 1e-4 * widened;
    const double distance_per_rate = (half_power_distance(widened + step, count, mode.interval) -
                                      half_power_distance(widened - step, count, mode.interval)) /
                                     (2 * step);
    const double density = 0.5 * mode.noise * mode.noise / mode.independent();
    const auto deviation = [&](const VectorXcd& slope) {
      return std::sqrt(density * slope.cwiseProduct(window).squaredNorm());
    };
    const double rate = widened - added, w = mode.turned_back + mode.line.slope.imag() + points.centre();
    const double textbook = half_power_distance(rate, count, mode.interval), size = std::hypot(rate, w);
    return {
        Complex(-rate, w), deviation(points.centre_slope),
        deviation(points.distance_slope) / distance_per_rate,
        fmt::format("Half power at {:.4g} Hz: the width alone of {:.3g} s of this decay, {:.3g} Hz, would "
                    "make its damping ratio {:.4g} %, {:.3g} % too large; the corrected one is {:.4g} %.",
                    size / (2 * std::numbers::pi), length, textbook / std::numbers::pi, 100 * textbook / size,
                    100 * (textbook / rate - 1), 100 * rate / size)};
  }

  double decay_;
};

const bool half_power_registered = modal_method_registry().add(
    {"half_power",
     "half-power width of each mode's spectrum, corrected for the finite record, for free decays",
     "[ewins2000]",
     {{"window_decay", 4.0, "", "(d + a) T of the exponential window; 0: no window"}},
     {contract::free_decay, contract::mode_by_mode},
     [](const filters::Options& options) {
       const double decay = options.number("window_decay");
       if (!(decay >= 0 && decay <= 20))
         throw std::invalid_argument(
             fmt::format("half_power: window_decay is {:g}; expected 0 to 20", decay));
       return std::make_unique<HalfPower>(decay);
     }});

}  // namespace
}  // namespace beamid::experiments
