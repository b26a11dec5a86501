// What single error of a measurement would account for modes that no parameters explain.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/update/modal_model.hpp"
#include "experiments/identify/update/modal_residual.hpp"
#include "experiments/identify/update/updating.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
