#include "experiments/identify/parts/widened_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/compare/widened_interval.hpp"

namespace beamid::experiments {

void widen_by_innovations(ComparedRun& run) {
  if (!run.has_estimate() || !run.diagnostics || !run.diagnostics->consistency) return;
  const filters::InnovationConsistency& found = *run.diagnostics->consistency;
  if (!(found.mean_normalised_square > std::max(1.0, found.upper_95))) return;
  const double factor = std::sqrt(found.mean_normalised_square);
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const auto place = static_cast<Eigen::Index>(j);
    const double deviation = factor * std::sqrt(run.unknown_state.covariance(place, place)) *
                             std::abs(run.unknowns[j].slope(run.unknown_state.mean[place]));
    if (!(deviation > run.parameters[j].estimate.deviation)) continue;
    run.parameters[j].estimate.deviation = deviation;
    set_interval(run, j, factor);
  }
  run.interval_factor = std::max(run.interval_factor, factor);
  constexpr double worth_saying = 1.1;
  if (factor > worth_saying)
    run.warnings.insert(
        run.warnings.begin(),
        fmt::format(
            "The innovations are {:.3g} times as large as the stated noise makes them (mean normalised "
            "square {:.3g}): deviations are widened by as much.",
            factor, found.mean_normalised_square));
}

}  // namespace beamid::experiments
