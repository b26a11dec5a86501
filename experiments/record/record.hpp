// A vibration record: measured and simulated alike.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace beamid::experiments {

/// What a channel measures.
enum class Quantity {
  displacement,
  velocity,
  acceleration,
  force,
  strain,
  base_acceleration,
  support_acceleration,
  angular_acceleration,
  support_angular_acceleration  ///< of parts alone: no file names it
};

/// What drives the motion: a force, the acceleration of all supports together, or that of one point whose
/// motion is taken as it was measured, whatever holds it.
inline bool is_input(Quantity quantity) {
  return quantity == Quantity::force || quantity == Quantity::base_acceleration ||
         quantity == Quantity::support_acceleration || quantity == Quantity::support_angular_acceleration;
}

/// How often a displacement is differentiated in time to make it; 0 also of what is no motion.
inline int times_differentiated(Quantity quantity) {
  switch (quantity) {
    case Quantity::velocity:
      return 1;
    case Quantity::acceleration:
    case Quantity::angular_acceleration:
      return 2;
    default:
      return 0;
  }
}

/// Whether it is of a point whose motion is taken as it was measured.
inline bool is_imposed(Quantity quantity) {
  return quantity == Quantity::support_acceleration || quantity == Quantity::support_angular_acceleration;
}

/// Whether it is of a rotation.
inline bool is_angular(Quantity quantity) {
  return quantity == Quantity::angular_acceleration || quantity == Quantity::support_angular_acceleration;
}

/// How a measured input runs between its samples: as an anti-aliased converter recorded it, straight from
/// sample to sample, or constant until the next one (which is late by half an interval).
enum class InputPath { band_limited, linear, held };

/// SI unit of a quantity: m, m/s, m/s2, N, m/m, rad/s2.
const char* si_unit(Quantity quantity);
const char* to_string(Quantity quantity);

/// What one channel measures, and where.
struct Channel {
  Quantity quantity = Quantity::acceleration;
  std::string name;
  std::optional<double> position = {};  ///< along the beam [m]; absent: the natural point
  double distance = 0.0;                ///< strain: of the surface from the axis, c of -c w'' [m]
  std::string place = {};               ///< of a structure whose places have names: "ridge.x"
  double noise = 0.0;                   ///< standard deviation of its white noise; 0: not stated
};

/// N samples of p measured channels, in SI units.
struct Record {
  Eigen::VectorXd time;                    ///< (N) [s], strictly increasing
  Eigen::MatrixXd samples;                 ///< (p x N), one column per instant
  std::vector<Channel> channels;           ///< p
  double time_resolution = 0.0;            ///< stamps are as exact as they were printed, within this [s]
  std::vector<std::string> remarks = {};   ///< for reports: lines left out, what was done to the samples
  std::vector<std::string> warnings = {};  ///< what may make any result wrong, for the first lines of reports
  std::vector<std::string> own_clock = {};   ///< names or quantities of channels stamped by other clocks
  std::optional<InputPath> input_path = {};  ///< absent: band-limited where stamps are even, else linear

  Eigen::Index size() const { return time.size(); }

  /// Mean sampling interval [s].
  double interval() const { return (time[size() - 1] - time[0]) / static_cast<double>(size() - 1); }

  /// One channel's history (N). @throws std::invalid_argument when no channel measures the quantity.
  Eigen::VectorXd channel(Quantity quantity) const;

  /// Their names (p).
  std::vector<std::string> channel_names() const;

  /// The samples whose time lies in [from, to] [s].
  /// @throws std::invalid_argument when the window leaves the record or holds fewer than 16 samples.
  Record window(double from, double to) const;
};

}  // namespace beamid::experiments
