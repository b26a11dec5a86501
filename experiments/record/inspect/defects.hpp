// What is wrong with a channel's samples, found once for all who read them.
#pragma once

#include <optional>
#include <vector>

#include "experiments/record/inspect/rattle.hpp"
#include "experiments/record/inspect/runs.hpp"

namespace beamid::experiments {

/// What a signal is taken for.
enum class SignalKind {
  motion,  ///< moves most of the time
  force,   ///< may rest at zero between pulses as short as one sample
};

struct Defects {
  bool dead = false;  ///< constant but for spikes, on an offset ten thousand times larger, or a thousand
                      ///< times and noise
  std::vector<Run> spikes, clipped, dropped, repeated;
  std::optional<Rattle> rattle;
};

/// Each in a signal without those before it: spikes, clipping, drop-outs, repeated samples. Of a force only
/// clipping and samples that are not numbers.
Defects find_defects(const std::vector<double>& samples, SignalKind kind);

}  // namespace beamid::experiments
