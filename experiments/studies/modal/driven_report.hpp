// The modes of a driven record, as a user sees them.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "experiments/modal/study/driven_study.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

// Modal masses from a hammer's impulse, as a user sees them.

/// A table `hammer_mass` and `hammer_mass` of results.json, one row for each mode and record:
/// hammer_study.hpp. Nothing where no record has a force with a hit.
/// @param rates of the modes of each record [rad/s]
/// @param coarse_reported whether hits of few samples have their warning already
void add_masses(const std::vector<std::string>& names, const std::vector<Record>& records,
                const std::vector<std::vector<std::complex<double>>>& rates, Results& results,
                bool coarse_reported = false);

/// A section for each record; figures, results.json.
Results report(const ModalStudySettings& settings, const std::vector<DrivenStudy>& studies);

}  // namespace beamid::experiments
