// What a discretisation does to the higher modes of a model.
#pragma once

#include <string>

#include "experiments/identify/verdict/run_verdict.hpp"

namespace beamid::experiments {

/// A sentence where the scheme of a run, by its closed form (discretisation_bias.hpp), moves the stiffness of
/// a mode that holds a hundredth of the record by more than the narrowest interval of the run: what is
/// determined by that mode comes out wrong by as much. Empty otherwise, for exact schemes and for models that
/// are not linear. Of damping likewise: the scheme of the run turns each pole of another motion,
/// log(g(lambda_f dt)) / dt, into that of the model as found; said where the damping ratio of a mode that the
/// record holds differs by more than the narrowest interval of a damping.
///
/// A mode holds what the outputs' spectra do within a tenth of its frequency; modes above half the sampling
/// rate are left out.
std::string step_error(const RunContext& context, const ComparedRun& run);

}  // namespace beamid::experiments
