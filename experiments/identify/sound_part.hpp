// The part of a free decay in which nothing befell the structure or its sensors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/record/prepare/record_defects.hpp"

namespace beamid::experiments {

struct SoundPart {
  double from = 0, to = 0;  ///< [s]
  std::string words;        ///< why it is not the whole, a sentence for reports
};

/// Of a free decay that is broken by clipped readings (of any channel, to a period behind them) or by jumps
/// of its motion (decay_jump.hpp, of the first channel), the part that determines frequency and damping best:
/// that of the largest energy times squared length. Where the frequency jumps, the side whose frequency is
/// nearer to the mode as described is left: on the other the clock is another one. Nothing where the decay is
/// whole, or where no part of eight periods is left.
///
/// Clipped readings are missing by what their own noise was and by what the motion rides on: those beside
/// them are a choice, whose mean is no longer that of the motion. With a noise of a sixth of the limit the
/// damping ratio then comes out a tenth too small, with a slow sway of a quarter of it, too.
/// @throws std::invalid_argument when the beam cannot be assembled
std::optional<SoundPart> sound_part(const Experiment& experiment, const Record& record,
                                    const std::vector<RecordDefect>& defects);

}  // namespace beamid::experiments
