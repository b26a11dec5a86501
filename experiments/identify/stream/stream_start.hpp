// What a stream of samples starts from: an earlier record of the same rig, or a saved state.
#pragma once

#include "experiments/config/experiment.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

/// A stream knows neither its noise nor its amplitude beforehand.
struct StreamStart {
  JointModel model;                 ///< on the basis that the earlier record led to
  IdentificationSettings settings;  ///< of one pass; the unknowns as uncertain as before any record
  double interval_factor = 1;       ///< of deviations, for the noise near the mode; 1 at least
  bool reliable = true;  ///< whether the earlier record, identified alike, has an estimate to rely on
  std::vector<Objection> objections = {};  ///< of that identification, the worst first
};

/// Identifies the earlier record with the experiment's model, reduction and filter (identify_with_model).
/// @throws InputError, std::invalid_argument as that, and where a force was measured: its path from sample to
/// sample is known when the next one has come, not before, if it is band-limited
StreamStart stream_start(const Experiment& experiment, const Record& earlier);

}  // namespace beamid::experiments
