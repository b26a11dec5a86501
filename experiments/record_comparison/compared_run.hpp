// One way to identify a record, from the model to its score.
#pragma once

#include "experiments/record_comparison/comparison.hpp"
#include "experiments/record_comparison/started_model.hpp"

namespace beamid::experiments {

/// How: a filter and a discretisation, and how often the record is filtered.
struct RunSettings {
  Choice filter;
  std::string discretisation;
  int passes = 3;
};

/// What every run of a comparison shares.
struct RunContext {
  const Experiment& experiment;
  const ComparedRecord& compared;
  std::optional<double> modal_frequency_hz;  ///< of the record's first output; absent: none was found
};

/// Filters the record as often as the settings say, the noise of each pass being what the one before left,
/// then reproduces the record and works out the Cramer-Rao bound. Numerical trouble is the run's status.
ComparedRun run_once(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
                     const RunSettings& settings);

}  // namespace beamid::experiments
