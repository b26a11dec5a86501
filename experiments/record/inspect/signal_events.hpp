// Hits and releases in a signal of which nothing is known beforehand.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamid::experiments {

struct SignalEvent {
  Eigen::Index sample = 0;  ///< at which the signal begins to rise
  double size = 0.0;        ///< the extreme within the window after it, from the signal's median
  bool pulse = false;       ///< of a signal that rests between events, as a hammer's force does
};

/// An event is a rise: within one window the signal goes further from its median than `rise` times what it
/// did in the window before, than ten times the noise and than a twentieth of its largest deviation. A decay
/// never does.
///
/// The window is two periods of the dominant frequency, at most a tenth of the record; of a signal that rests
/// between pulses (a hundredth of its peak in the median, and five times its noise) it is eight samples. A
/// signal of fewer than five cycles is no vibration and has no events.
/// @param noise standard deviation. @param frequency_hz dominant; 0 where there is none.
std::vector<SignalEvent> find_events(const Eigen::VectorXd& signal, double interval, double noise,
                                     double frequency_hz);

/// Adds the release of a hand that pulled slowly: the signal's differences rise as an event does, from a
/// deflection of a third of the largest deviation or more; its size is that deflection. The pull itself, from
/// which on the signal stays on one side until then, is no event.
void take_slow_release(const Eigen::VectorXd& signal, double interval, double frequency_hz,
                       std::vector<SignalEvent>& events);

}  // namespace beamid::experiments
