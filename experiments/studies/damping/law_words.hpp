// What a record says of damping laws, in sentences.
#pragma once

#include <string>

#include "experiments/identify/damping_law/damping_law.hpp"

namespace beamid::experiments {

const char* law_title(const std::string& law);
std::string law_verdict(const DampingLawStudy& study);  ///< which law, by how much, and over what amplitudes
std::string law_fit_words(const DampingLawStudy& study);  ///< whether the best of them is good enough

/// What the record supports, and whether that fits: sentences.
std::string law_words(const DampingLawStudy& study);

}  // namespace beamid::experiments
