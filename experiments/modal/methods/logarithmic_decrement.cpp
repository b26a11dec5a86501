// Logarithmic decrement of each mode, isolated [rao2018].
#include "experiments/modal/classic_estimators.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/modal/mode_by_mode.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;

/// Re(2 z e^(i w t)), 40 samples a cycle: log z between two values is a line, which for a decay it is.
VectorXd decrement_motion_of(const IsolatedMode& mode, double interval) {
  const Index last = mode.values.size() - 1;
  const auto count = static_cast<Index>(std::floor(static_cast<double>(last) * mode.interval / interval)) + 1;
  VectorXd motion(count);
  for (Index k = 0; k < count; ++k) {
    const double time = interval * static_cast<double>(k), at = time / mode.interval;
    const Index m = std::min(static_cast<Index>(at), last - 1);
    const double part = at - static_cast<double>(m);
    const Complex logarithm = (1 - part) * mode.logarithm[m] + part * mode.logarithm[m + 1];
    motion[k] = 2 * std::exp(logarithm + Complex(0, mode.turned_back * time)).real();
  }
  return motion;
}

class LogarithmicDecrement final : public ModeByModeMethod {
 public:
  explicit LogarithmicDecrement(double smallest_swing) : settings_{smallest_swing} {}

 private:
  ModeAnswer estimate(const IsolatedMode& mode) const override {
    const double period = 2 * std::numbers::pi / mode.rate().imag();
    const DecrementEstimate found =
        logarithmic_decrement(decrement_motion_of(mode, period / 40), period / 40, settings_);
    const double w = 2 * std::numbers::pi * found.frequency_hz;
    // Peaks half a cycle apart share the noise that the kernel correlates over a longer time.
    const double shared = std::max(1.0, mode.correlation / (0.5 * period));
    const double independent = std::max(found.peaks / shared, 2.5);
    const double wider = std::sqrt(shared * independent / (independent - 2));
    return {w * Complex(-found.damping_ratio, std::sqrt(1 - found.damping_ratio * found.damping_ratio)),
            wider * 2 * std::numbers::pi * found.frequency_standard_deviation_hz,
            wider * w * found.damping_ratio_standard_deviation};
  }

  DecrementSettings settings_;
};

const bool logarithmic_decrement_registered = modal_method_registry().add(
    {"logarithmic_decrement",
     "how fast the peaks of each isolated mode shrink, for free decays",
     "[rao2018]",
     {{"smallest_swing", 0.1, "", "swings below this part of the largest one are omitted"}},
     {contract::free_decay, contract::mode_by_mode},
     [](const filters::Options& options) {
       const double least = options.number("smallest_swing");
       if (!(least > 0 && least < 1))
         throw std::invalid_argument("logarithmic_decrement: smallest_swing is " + std::to_string(least) +
                                     "; expected more than 0 and less than 1");
       return std::make_unique<LogarithmicDecrement>(least);
     }});

}  // namespace
}  // namespace beamid::experiments
