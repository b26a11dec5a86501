#include "experiments/identify/run_diagnostics.hpp"

namespace beamid::experiments {

using Eigen::Index;

std::optional<filters::Diagnostics> diagnostics_of(const filters::FilterRun& run,
                                                   const filters::Gaussian& initial,
                                                   const std::vector<Index>& unknowns) {
  constexpr Index fewest = 100;
  const Index reached = run.failure ? run.failure->step : run.normalised_squares.size();
  if (reached < fewest) return std::nullopt;
  return filters::diagnose(run, initial, unknowns);
}

}  // namespace beamid::experiments
