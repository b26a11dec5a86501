#include "experiments/rig/audible_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

// Modes below half the sampling rate: what an instrument's anti-aliasing filter lets through. One above
// appears in the record at another frequency.
struct Audible {
  Index count = 0;       ///< 200 at most
  double next_hz = 0.0;  ///< frequency of the first above; 0: there is none
};

Audible audible_modes(const fem::StructuralSystem& system, double limit_hz) {
  constexpr Index most = 200;
  for (Index few = std::min<Index>(system.size(), 25);;
       few = std::min(2 * few, std::min(system.size(), most))) {
    const VectorXd frequency = fem::modes(system, few).frequency_hz();
    const Index below = (frequency.array() < limit_hz).count();
    if (below < few) return {below, frequency[below]};
    if (few == std::min(system.size(), most)) return {few, 0.0};
  }
}

}  // namespace

fem::ResponseMethod audible_method(const Simulation& settings, const fem::StructuralSystem& system,
                                   std::vector<std::string>& notes) {
  fem::ResponseMethod method = settings.method;
  const double limit = 0.5 * settings.sampling_rate;
  const Audible audible = audible_modes(system, limit);
  if (audible.count == 0 && audible.next_hz > 0.0)
    notes.push_back(fmt::format(
        "ALIASED: no mode lies below half the sampling rate, {:g} Hz. The first, at {:.5g} Hz, appears in "
        "the record at {:.5g} Hz.",
        limit, audible.next_hz, std::abs(std::remainder(audible.next_hz, settings.sampling_rate))));
  if (method.name == "modal" && !method.options.contains("modes") && audible.count > 0) {
    method.options["modes"] = static_cast<double>(audible.count);
    notes.push_back(fmt::format("{} of {} modes {} used: {}. simulation.modes sets another number.",
                                audible.count, system.size(), audible.count == 1 ? "is" : "are",
                                audible.next_hz > 0.0
                                    ? fmt::format("{} below {:g} Hz, half the sampling rate",
                                                  audible.count == 1 ? "the one" : "those", limit)
                                    : "the lowest"));
  } else if (method.name == "modal" && !method.options.contains("modes")) {
    method.options["modes"] = 1.0;
  } else if (audible.count > 0 && audible.next_hz > 0.0 &&
             (method.name != "modal" || method.options["modes"] == 0.0 ||
              method.options["modes"] > static_cast<double>(audible.count))) {
    notes.push_back(fmt::format(
        "Half the sampling rate is {:g} Hz, the frequency of mode {} is {:.5g} Hz: this mode and those "
        "above it appear in the record at other frequencies.",
        limit, audible.count + 1, audible.next_hz));
  }
  return method;
}

}  // namespace beamid::experiments
