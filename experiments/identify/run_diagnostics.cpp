#include "experiments/identify/run_diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

std::string failure_sentences(const std::vector<filters::Failure>& events) {
  constexpr std::size_t listed = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(listed, events.size()); ++i)
    text += fmt::format("{}Sample {}, {:.4f} s: {}{}.", i ? " " : "", events[i].step, events[i].time,
                        events[i].reason,
                        std::isnan(events[i].smallest_eigenvalue)
                            ? ""
                            : fmt::format(" (smallest eigenvalue {:.3g})", events[i].smallest_eigenvalue));
  if (events.size() > listed) text += fmt::format(" And {} more events.", events.size() - listed);
  return text;
}

}  // namespace beamid::experiments
