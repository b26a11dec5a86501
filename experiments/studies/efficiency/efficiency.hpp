// Filters against the Cramer-Rao bound, over seeded runs.
#pragma once

#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/studies/efficiency/free_decays.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// How a filter gets from the guess to its answer.
enum class Passes {
  lengthening,  ///< lengthening_passes(), from the first cycle on
  single        ///< once through the record, from the guess
};
const char* to_string(Passes passes);

struct EfficiencySettings {
  std::vector<Choice> filters;
  std::vector<double> damping_ratios{0.0015, 0.01, 0.1};
  std::vector<Passes> passes{Passes::lengthening, Passes::single};
  int runs = 2000;
  int sampled_runs = 100;  ///< of filters that draw samples: a thousand times slower
  std::uint64_t seed = 1;  ///< of the first run; the next run has the next
  DecaySettings decay;     ///< but for the damping ratio
};

/// All registered filters that take models that are not linear.
std::vector<Choice> applicable_filters();

/// One filter on one kind of record.
struct EfficiencyCase {
  Choice filter;
  Passes passes = Passes::lengthening;
  double damping_ratio = 0.0;
  Oscillator truth;
  Eigen::Vector2d bound;    ///< of K and C
  Eigen::Vector2d largest;  ///< errors beyond these count as lost: 5 % of K, half of C, or ten bounds
  filters::MonteCarloResult result;  ///< of K and C; empty vectors where all runs were lost
};

struct Efficiency {
  EfficiencySettings settings;
  std::vector<EfficiencyCase> cases;  ///< by damping ratio, then passes, then filter
};

/// Trials run on all processors; the numbers do not depend on how many there are.
/// @throws std::invalid_argument when nothing is asked for, runs < 2, or as FreeDecays and the filters do.
Efficiency find_efficiency(const EfficiencySettings& settings, const Progress& progress);

}  // namespace beamid::experiments
