// Everything that updating a structure by measured modes finds.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/twins/deciding_measurement.hpp"
#include "experiments/identify/twins/twins.hpp"
#include "experiments/identify/update/modal_model.hpp"
#include "experiments/identify/update/modal_residual.hpp"
#include "experiments/identify/update/updating.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

// What single error of a measurement would account for modes that no parameters explain.

/// A change of the measurement with which the parameters explain it.
struct Remedy {
  std::string sentence;
  double chi_square = 0.0;
};

struct RemedyRequest {
  const Experiment& experiment;
  const ModalModel& model;
  const SearchSpace& space;
  const ModalData& data;
  ModelTrust trust;
  const Updating& updating;  ///< without any change
};

/// Modes left out one by one, sensors left out one by one or exchanged by twos, and, of modes without shapes,
/// numbers counted on from a mode that was not found. The parameters are fitted anew to each. Those whose
/// chi^2 is below its 95 % limit, the best first, three at most; all within 6 of the best.
std::vector<Remedy> remedies(const RemedyRequest& request);

/// The model and its residual, then the answers. It is not copied: the residual refers to the model.
struct UpdateStudy {
  std::unique_ptr<const ModalModel> model;
  std::unique_ptr<const SearchSpace> space;
  std::unique_ptr<const ModalResidual> residual;
  UpdateSettings settings;
  TwinSearch twins;
  Updating updating;
  PredictedModes described;                   ///< before anything is changed
  std::vector<DecidingMeasurement> deciding;  ///< between the sets that fit as well
  std::vector<Remedy> remedies;               ///< where no values explain the modes
  std::vector<Objection> objections;

  const ModalData& data() const { return residual->data(); }
  const std::vector<Unknown>& unknowns() const { return model->asked().unknowns; }
  /// All that fit as well, and none can be missing.
  bool complete() const { return twins.complete(); }
};

/// @throws InputError, std::invalid_argument as the parts do.
UpdateStudy study_update(const Experiment& experiment, const ModalData& data, const UpdateSettings& settings,
                         const Progress& progress = unwatched);

/// The frequencies of the structure as described, as many as parameters are asked about, as if measured.
ModalData described_modes(const Experiment& experiment);

}  // namespace beamid::experiments
