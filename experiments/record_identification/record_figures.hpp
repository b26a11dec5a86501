// Pictures of an identification: measured against reproduced motion, and convergence with its band.
#pragma once

#include <vector>

#include "experiments/output/figure.hpp"
#include "experiments/record_identification/record_identification.hpp"

namespace beamid::experiments {

std::vector<Figure> figures(const Record& record, const RecordIdentification& found);

}  // namespace beamid::experiments
