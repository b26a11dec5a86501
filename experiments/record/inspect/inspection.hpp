// What is in a record's file, channel by channel, of which nothing need be known beforehand.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/record/inspect/defects.hpp"
#include "experiments/record/inspect/offset_drift.hpp"
#include "experiments/record/inspect/sampling_check.hpp"
#include "experiments/record/inspect/signal_events.hpp"
#include "experiments/record/record_format.hpp"

namespace beamid::experiments {

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
