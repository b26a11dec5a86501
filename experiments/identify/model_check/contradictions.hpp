// Records that contradict each other.
#pragma once

#include <optional>

#include "experiments/identify/model_check/model_check.hpp"

namespace beamid::experiments {

/// Of one structure: a record that shows no mode where others do, but one of its own within a factor of 2 of
/// it and nearer to it than to any other, is of another beam. The fewer are named:
/// "c.csv contradicts a.csv, b.csv: mode 1 is at 19.86 Hz there and at 14.4 Hz here."
/// @param matched modes of the structure; @param strays those without a prediction; loses those that are
/// named
std::vector<std::string> contradictions_of(const std::vector<CheckedMode>& matched,
                                           std::vector<ObservedMode>& strays);

/// Modes of structures that are far off their prediction leave the check where more than half of the
/// structures are not; the contradictions name them, and whose prediction they meet.
void set_far_structures_aside(ModelCheck& check);

/// Of three structures or more that no single change explains: the one without which the others are as
/// described or one plausible change explains them; nothing where there is none or more than one.
std::optional<Outlier> outlier_of(const ModelCheck& check);

}  // namespace beamid::experiments
