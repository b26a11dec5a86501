// What in a free decay speaks against any one frequency and damping ratio of it.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/analysis.hpp"

namespace beamid::experiments {

struct DecayObjection {
  std::string text;          ///< a sentence or more for the first lines of a report
  bool contradicts = false;  ///< the estimates are not to be relied on
};

/// - A jump of the motion (decay_jump.hpp) in what was identified: no single decay goes across it. By a
///   twentieth of the amplitude, or of a radian, or of its frequency, it contradicts.
/// - The overtone of a sensor that saturates softly (third_overtone.hpp), where the damping ratio is wrong by
///   more than its interval through it, and the frequency does not follow the amplitude as that of a spring
///   would; it contradicts from twice the interval on.
/// @param mode as identified, with its deviations as they are reported
std::vector<DecayObjection> decay_objections(const RecordAnalysis& analysis, const FoundMode& mode);

}  // namespace beamid::experiments
