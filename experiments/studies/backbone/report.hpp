// Tables, sentences, figures and results.json keys of `beamid backbone`.
#pragma once

#include <string>

#include "experiments/identify/backbone/backbone_study.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

Results report(const BackboneSettings& settings, const Record& record, const std::string& record_name,
               const BackboneStudy& study);

/// K(A), C(A), the backbone with its band, G/Gmax and D by amplitude. @param mass [kg]
Figure backbone_figure(const BackboneStudy& study, double mass);

}  // namespace beamid::experiments
