// The sensors and the logger of a virtual test.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace beamid::experiments {

/// Of one channel. Shares are of the channel's largest true reading, so that they mean the same for every
/// quantity.
struct SensorDefects {
  double clipping = 0.0;      ///< readings end at +- this share; 0: nowhere
  double resolution = 0.0;    ///< step of the converter, a share; 0: none
  double offset = 0.0;        ///< a share
  double drift = 0.0;         ///< change of the offset over the record, a share
  double startup = 0.0;       ///< further offset at the first sample, a share; it fades exponentially
  double startup_time = 0.2;  ///< time constant of that [s]
  double rattle = 0.0;        ///< standard deviation of the noise of a loose contact, a share
  double rattle_above = 0.5;  ///< it rattles where the true reading is beyond +- this share
  bool dead = false;          ///< nothing but the offset, whatever moves

  bool operator==(const SensorDefects&) const = default;
};

/// Of the logger that all channels share.
struct Acquisition {
  double pretrigger = 0.0;        ///< recorded before the excitation begins [s]
  double jitter = 0.0;            ///< standard deviation of the intervals, a share of their mean
  double median_shortfall = 0.0;  ///< by which the median interval is shorter than the mean, a share of it
  int gaps = 0;                   ///< how often samples are missing
  std::pair<double, double> gap{0.01, 0.3};    ///< shortest and longest gap [s]
  double repeated = 0.0;                       ///< share of samples that show the reading before once more
  bool force = true;                           ///< the exciting force is measured, but for a release
  double force_noise = 0.0, base_noise = 0.0;  ///< standard deviations of that record [N], [m/s2]
  std::vector<SensorDefects> sensors = {};     ///< in the order of the sensors; missing ones have no defect

  bool operator==(const Acquisition&) const = default;

  /// Whether every reading is there, where and as the sensor gave it.
  bool perfect() const {
    Acquisition ideal;
    ideal.gap = gap;
    ideal.force = force;
    ideal.force_noise = force_noise;
    ideal.base_noise = base_noise;
    ideal.sensors.resize(sensors.size());
    return *this == ideal;
  }
  bool even() const { return !(jitter > 0) && gaps == 0; }  ///< samples at equal intervals throughout
  SensorDefects of(std::size_t sensor) const {
    return sensor < sensors.size() ? sensors[sensor] : SensorDefects{};
  }
};

/// The largest share of the jitter by which a median can fall short of the mean here: late samples are drawn
/// from a gamma distribution, which can do no more.
inline constexpr double largest_shortfall = 0.41;

}  // namespace beamid::experiments
