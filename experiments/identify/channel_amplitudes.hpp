// Whether the channels of a free decay are as large, beside each other, as the mode's shape makes them.
#pragma once

#include <string>

#include "experiments/config/experiment.hpp"

namespace beamid::experiments {

struct RecordAnalysis;

/// In the mode s of a free decay, y_i = Re(a_i e^(st)), the structure as described moves by u_i where channel
/// i sits, so that
///
///     a_i / a_1 = (u_i s^k_i) / (u_1 s^k_1),   k = 0, 1, 2 of displacement and strain, velocity,
///     acceleration
///
/// A channel whose unit is wrong is off by a large factor, which no K and C make up for: the filter shares
/// the contradiction among them. A place that is 10 % of the length off makes a factor of 1.2 or so.
struct ChannelAmplitudes {
  std::string text;  ///< names channels off by a factor of 1.5 or more, beyond their noise, or with the wrong
                     ///< sign; empty: none is, the motion is forced, or the analysis has no mode
  bool contradict =
      false;  ///< one by a factor of 3 or its sign, which no place that is not quite right makes
};

ChannelAmplitudes channel_amplitudes(const Experiment& experiment, const RecordAnalysis& analysis);

}  // namespace beamid::experiments
