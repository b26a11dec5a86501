// When something happens in a signal: hits and releases.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <string>
#include <vector>

namespace beamid::experiments {

/// The largest value in a window that moves forward, in constant time a step.
class SlidingMaximum {
 public:
  explicit SlidingMaximum(const Eigen::VectorXd& values) : values_(values) {}

  /// The first place of the largest value from `from` to before `to`, at least one; neither may fall from
  /// call to call.
  Eigen::Index over(Eigen::Index from, Eigen::Index to);

 private:
  const Eigen::VectorXd& values_;
  std::deque<Eigen::Index> places_;  // of values that fall
  Eigen::Index next_ = 0;
};

/// How a signal departs from its median by more than a twentieth of its farthest sample, the peak.
struct Excursions {
  double share = 0;     ///< of its samples that do
  double opposite = 0;  ///< the largest departure to the other side, of the peak
};

/// @param signal (N) finite; zero where it does not move
Excursions excursions_of(const Eigen::VectorXd& signal);

struct OnsetSettings {
  double threshold = 8;       ///< times the noise before the first event
  double smallest = 0.05;     ///< relative to the largest deviation: less is no event
  double rise = 1.5;          ///< times what the signal did within `apart` before: less is the same vibration
  double apart = 0.2;         ///< [s], at least half a period of the vibration
  double quiet_duration = 0;  ///< [s] at the record's start that hold noise only; 0: found
};

struct Onsets {
  double baseline = 0;                ///< mean of the quiet part [unit of the signal]
  double noise = 0;                   ///< its standard deviation
  Eigen::Index quiet = 0;             ///< samples before the first event, or all
  std::vector<Eigen::Index> samples;  ///< at which events begin, rising
};

/// The quiet part grows from the record's first eight samples until one is further from their mean than both
/// `threshold` standard deviations and the smallest event. Smooth motion never does that, so that a record
/// that starts in motion has no quiet part and no event. Behind it, an event is a sample beyond both levels
/// that is `rise` times larger than all within `apart` before it.
/// @param signal (N), at least 16 samples
/// @throws std::invalid_argument when the signal is shorter, or a setting is not positive.
Onsets find_onsets(const Eigen::VectorXd& signal, double interval, const OnsetSettings& settings = {});

/// An instant to four digits, and of a time of day to a tenth of a second: "6.248", "45180.1".
std::string instant_text(double seconds);

}  // namespace beamid::experiments
