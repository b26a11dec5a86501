// What in a free decay makes its modes wrong by more than their deviations.
#pragma once

#include <string>
#include <vector>

#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// Sentences about the strongest mode in the channel that shows it best: a jump of the motion on the way
/// (decay_jump.hpp), and the overtone of a sensor that saturates softly (third_overtone.hpp), where the
/// damping ratio is wrong by more than two of its deviations through it.
std::vector<std::string> decay_warnings(const RecordModes& found);

}  // namespace beamid::experiments
