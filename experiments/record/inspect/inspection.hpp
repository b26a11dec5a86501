// What is in a record's file, channel by channel, of which nothing need be known beforehand.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/record/inspect/defects.hpp"
#include "experiments/record/record.hpp"

namespace beamid::experiments {

// Hits and releases in a signal of which nothing is known beforehand.

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

// Are the instants of a record evenly spaced, and where not?

struct SamplingCheck {
  double interval = 0.0;  ///< median [s]
  double jitter = 0.0;    ///< root mean square of the intervals' distance from their mean, gaps aside [s]
  std::vector<std::size_t>
      gaps;  ///< samples that come more than half an interval too late; where stamps jitter, more than 1.5
  std::vector<std::size_t> repeats;  ///< samples whose stamp is that of the one before
  std::vector<std::size_t> returns;  ///< samples before the one before
  double longest_gap = 0.0;          ///< [s]
  bool uniform = true;  ///< every interval within 5 % of the median, or within the rounding of the stamps
};

/// @param times [s], at least two. @param resolution to which they are printed [s].
SamplingCheck check_sampling(const std::vector<double>& times, double resolution);

// An offset that wanders through a record, or settles at its start.

struct OffsetDrift {
  double from = 0, to = 0;   ///< lowest and highest mean [unit of the signal]
  bool start_up = false;     ///< all of it at the beginning: an amplifier that settles
  Eigen::Index settled = 0;  ///< sample from which on it stays, where it is a start-up
};

/// Means of up to twenty parts of the signal, whole periods and two at least, between which the offset goes
/// by more than a quarter of the signal's largest deviation and ten times what noise does to such a mean.
/// Nothing where five parts do not fit.
/// @param period of the vibration [samples]; 0: none. @param noise standard deviation
std::optional<OffsetDrift> offset_drift(const Eigen::VectorXd& signal, double period, double noise);

struct InspectedChannel {
  int column = 0;                              ///< from 1
  std::string name, unit;                      ///< as the file has them; "" where it does not say
  std::string file_unit;                       ///< of its numbers, where the quantity is stated
  std::optional<Quantity> quantity;            ///< stated by file or format; samples are then in SI units
  std::vector<double> samples;                 ///< NaN where there is no number
  std::size_t missing = 0;                     ///< of these
  double least = 0, greatest = 0, offset = 0;  ///< offset: the median
  double drift = 0;                            ///< change of a fitted line over the record
  double noise = 0;                            ///< standard deviation
  double signal_to_noise_db = 0;               ///< of mean squares, without offset
  double frequency_hz = 0;                     ///< dominant; 0: none
  Defects defects;
  std::vector<SignalEvent> events;
  std::optional<OffsetDrift> wandering;  ///< of the offset
};

struct Inspection {
  std::string file, reader;
  std::vector<double> time;  ///< [s], or sample numbers where nothing tells the time
  std::string time_text;     ///< where the times come from
  std::string time_key;      ///< what says so in the table [record]; empty: the file does
  bool has_time = true;
  bool mean_rate =
      false;  ///< uneven counts of samples share a stamp: instants are counted at their mean rate
  double resolution = 0.0;  ///< of printed stamps [s]
  SamplingCheck sampling;
  std::vector<InspectedChannel> channels;
  std::vector<std::size_t> skipped_lines;
  std::vector<std::string> remarks;
  std::vector<std::string> warnings;  ///< what the file itself makes wrong, from its reader
};

/// Reads a file, malformed lines counted, and looks at every column of numbers but time, or at those that the
/// format names. Where nothing tells which column is time, one that rises is taken for it: of those named
/// like time, else the first.
/// @throws InputError.
Inspection inspect(const std::filesystem::path& file, const RecordFormat& format);

}  // namespace beamid::experiments
