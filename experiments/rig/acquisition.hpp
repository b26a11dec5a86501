// What cheap sensors and loggers do to the readings of a test.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "experiments/config/channel_places.hpp"
#include "experiments/record/record.hpp"

namespace beamid::experiments {

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
