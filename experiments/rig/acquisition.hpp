// What cheap sensors and loggers do to the readings of a test.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "experiments/record.hpp"

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
};

/// Of the logger that all channels share.
struct Acquisition {
  double pretrigger = 0.0;        ///< recorded before the excitation begins [s]
  double jitter = 0.0;            ///< standard deviation of the intervals, a share of their mean
  double median_shortfall = 0.0;  ///< by which the median interval is shorter than the mean, a share of it
  int gaps = 0;                   ///< how often samples are missing
  std::pair<double, double> gap{0.01, 0.3};  ///< shortest and longest gap [s]
  double repeated = 0.0;                     ///< share of samples that show the reading before once more
  bool force = true;                         ///< the exciting force is measured, but for a release
  std::vector<SensorDefects> sensors = {};   ///< in the order of the sensors; missing ones have no defect

  bool even() const { return !(jitter > 0) && gaps == 0; }  ///< samples at equal intervals throughout
  SensorDefects of(std::size_t sensor) const {
    return sensor < sensors.size() ? sensors[sensor] : SensorDefects{};
  }
};

/// The largest share of the jitter by which a median can fall short of the mean here: late samples are drawn
/// from a gamma distribution, which can do no more.
inline constexpr double largest_shortfall = 0.41;

/// Instants (N) of the samples [s], the first at 0, the last at (N - 1) / rate. The intervals are
///
///     dt = (a + g) / rate,   g of a gamma distribution, a such that the mean is 1 / rate,
///
/// whose shape is found from the shortfall of the median and whose scale from the jitter: a loop that waits
/// the same time after every sample and is held up now and then. Without a shortfall they are normal. None is
/// shorter than a twentieth of the mean. Stamps are true: a reading belongs to its instant.
/// @throws std::invalid_argument when the shortfall is beyond largest_shortfall times the jitter.
Eigen::VectorXd sample_instants(const Acquisition& acquisition, Eigen::Index count, double rate,
                                std::uint64_t seed);

/// What a channel shows (N) of true readings (N) at instants (N): rattle, drift, start-up and offset are
/// added, the sum is clipped, then rounded.
/// @param noise (N) of the sensor itself. @param stream of the rattle, within the seed.
Eigen::VectorXd shown_readings(const SensorDefects& sensor, const Eigen::VectorXd& time,
                               const Eigen::VectorXd& readings, const Eigen::VectorXd& noise,
                               std::uint64_t seed, std::uint64_t stream);

/// Repeats the reading before in the asked share of the samples, of all channels at once, and takes the
/// samples of the gaps out: one gap somewhere in each of as many equal parts of the record, its length drawn
/// evenly on a logarithmic scale.
void lose_samples(const Acquisition& acquisition, Record& record, std::uint64_t seed);

}  // namespace beamid::experiments
