// Whether a base and what stands on it were recorded as described: their order, a sign, a common clock.
#pragma once

#include "experiments/modal/base_response.hpp"

namespace beamid::experiments {

/// What of the two channels, changed, explains their motion much better.
struct ChannelFault {
  enum class Kind {
    none,
    reversed,  ///< the response with its sign turned
    late,      ///< the response some samples earlier; negative: later
    exchanged  ///< the base for the response
  };
  Kind kind = Kind::none;
  int samples = 0;            ///< by which the response is late
  BaseResponse instead;       ///< what is found then
  double left_percent = 0.0;  ///< of the channels as they are; infinite where they show no mode
  bool surely() const { return kind != Kind::none; }
};

inline constexpr int most_late_samples = 10;

/// Fits the lowest mode, whatever band is asked about, to the channels as they are and changed: about a
/// higher one those below it are not in the model. A change counts where the fit leaves less than 0.7 of what
/// it left (half of its square), or, of a participation below zero, less with the sign turned. The order is
/// doubted only where the response moves less than the base, or xi is above 0.3. Where the channels show no
/// mode, every change that gives one counts.
ChannelFault channel_fault(const Eigen::VectorXd& base, const Eigen::VectorXd& response, double interval);

}  // namespace beamid::experiments
