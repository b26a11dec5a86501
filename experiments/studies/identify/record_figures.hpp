// Pictures of an identification: measured against reproduced motion, and convergence with its band.
#pragma once

#include <vector>

#include "experiments/identify/record_identification.hpp"
#include "experiments/results/figure.hpp"

namespace beamid::experiments {

std::vector<Figure> figures(const Record& record, const RecordIdentification& found);

}  // namespace beamid::experiments
