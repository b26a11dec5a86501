#include "experiments/modal_study/decay_polish.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/modal_analysis/joint_decay_fit.hpp"

namespace beamid::experiments {
namespace {

Pole fitted(const JointDecayFit& fit, std::size_t m) {
  Pole pole{fit.rates[m], fit.shapes.col(static_cast<Eigen::Index>(m))};
  const auto at = static_cast<Eigen::Index>(2 * m);
  pole.take_deviations(fit.covariance.block<2, 2>(at, at));
  return pole;
}

/// Why a fitted mode is none; empty: it is one.
std::string objection_to(const Pole& from, const Pole& to, const RecordModes& found,
                         const StabilisationSettings& settings) {
  const double resolution = 1 / (found.interval * static_cast<double>(found.target.cols()));
  const double moved = std::abs(to.frequency_hz() - from.frequency_hz());
  if (!(to.damping_ratio() > 0 && moved < std::max(0.05 * from.frequency_hz(), resolution)))
    return "least squares do not keep it";
  if (to.frequency_deviation_hz > settings.largest_frequency_deviation * to.frequency_hz())
    return fmt::format("too uncertain, standard deviation {:.2g} Hz", to.frequency_deviation_hz);
  if (to.damping_ratio_deviation > to.damping_ratio())
    return fmt::format("too uncertain, damping ratio {:.2g} % with standard deviation {:.2g} %",
                       100 * to.damping_ratio(), 100 * to.damping_ratio_deviation);
  return "";
}

}  // namespace

void polish(RecordModes& found, const StabilisationSettings& settings) {
  try {
    while (!found.modes.empty()) {
      std::vector<std::complex<double>> start;
      for (const ModeEstimate& mode : found.modes) start.push_back(mode.pole.rate);
      const JointDecayFit fit = fit_decays_jointly(found.target, found.interval, start);
      std::size_t worst = start.size();  // only the least certain goes: without it, others may stay
      double largest = -1;
      std::string why;
      for (std::size_t m = 0; m < start.size(); ++m) {
        const Pole pole = fitted(fit, m);
        const std::string objection = objection_to(found.modes[m].pole, pole, found, settings);
        const double doubt = pole.frequency_deviation_hz / pole.frequency_hz();
        if (objection.empty() || doubt <= largest) continue;
        worst = m;
        largest = doubt;
        why = objection;
      }
      if (worst == start.size()) {
        for (std::size_t m = 0; m < start.size(); ++m) found.modes[m].pole = fitted(fit, m);
        std::sort(found.modes.begin(), found.modes.end(),
                  [](const auto& a, const auto& b) { return a.pole.frequency_hz() < b.pole.frequency_hz(); });
        found.polished = true;
        return;
      }
      const ModeEstimate& lost = found.modes[worst];
      found.stabilisation.rejected.push_back({lost.pole, lost.orders, why});
      found.modes.erase(found.modes.begin() + static_cast<std::ptrdiff_t>(worst));
    }
  } catch (const std::exception& error) {
    found.warnings.push_back(std::string("Not polished: ") + error.what() + ".");
  }
}

}  // namespace beamid::experiments
