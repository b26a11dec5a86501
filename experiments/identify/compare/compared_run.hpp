// One way to identify a record, from the model to its score.
#pragma once

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/identify/compare/started_model.hpp"
#include "experiments/models/divergence.hpp"

namespace beamid::experiments {

/// How: a filter and a discretisation, and how often the record is filtered.
struct RunSettings {
  Choice filter;
  std::string discretisation;
  int passes = 3;
  double true_mass = 0.0;  ///< of one degree of freedom of the beam simulated, by true_mass() [kg]
};

/// What every run of a comparison shares.
struct RunContext {
  const Experiment& experiment;
  const ComparedRecord& compared;
  std::optional<FoundMode> modal;  ///< of the record's first output; absent: none was found
};

/// The frequency at which a record of this rate shows a mode: below half the rate its own, above it another.
double shown_at(double frequency_hz, double sampling_rate_hz);

/// Filters the record as often as the settings say, then reproduces it and works out the Cramer-Rao bound.
/// Each pass is linearised about what the one before found, on a basis of the beam there, with the noise that
/// this motion left; what is known beforehand counts once, as the initial estimate has it, however many
/// passes. The bound is that with the noise in the record: of a simulated one, what the best motion leaves,
/// at least the sensors' own; of a measured one, what the filter assumes. Numerical trouble is the run's
/// status.
ComparedRun run_once(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
                     const RunSettings& settings);

}  // namespace beamid::experiments
