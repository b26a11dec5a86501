// What an axis of a figure shows of a channel.
#pragma once

#include <string>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// "acceleration [m/s2]"
inline std::string axis_label(Quantity quantity) {
  return std::string(to_string(quantity)) + " [" + si_unit(quantity) + "]";
}

/// "tip, acceleration"
inline std::string channel_title(const Channel& channel) {
  return (channel.name.empty() ? "" : channel.name + ", ") + to_string(channel.quantity);
}

}  // namespace beamid::experiments
