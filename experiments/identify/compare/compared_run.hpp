// One way to identify a record, from the model to its score.
#pragma once

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/identify/compare/started_model.hpp"

namespace beamid::experiments {

/// How: a filter and a discretisation, and how often the record is filtered.
struct RunSettings {
  Choice filter;
  std::string discretisation;
  int passes = 3;
  double true_mass = 0.0;  ///< of one degree of freedom of the beam simulated, by true_mass() [kg]
  filters::Keep keep = filters::Keep::last_estimate;
};

/// What every run of a comparison shares.
struct RunContext {
  const Experiment& experiment;
  const ComparedRecord& compared;
  const RecordAnalysis& analysis;
};

/// Filters the record as often as the settings say, then reproduces it and works out the Cramer-Rao bound.
///
/// Each pass is linearised about what the one before found, on a basis of the beam there, with the noise that
/// this motion left, or, of one coordinate, the mode of the modal analysis, which knows no discretisation;
/// what is known beforehand counts once, as the initial estimate has it, however many passes. The bound is
/// that with the noise in the record: of a simulated one, what the best motion leaves, at least the sensors'
/// own; of a measured one, what the filter assumes. Numerical trouble is the run's status.
ComparedRun run_once(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
                     const RunSettings& settings);

}  // namespace beamid::experiments
