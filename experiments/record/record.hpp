// A vibration record: measured and simulated alike.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/text/choice.hpp"
#include "experiments/text/objection.hpp"

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
  std::vector<Objection> objections = {};  ///< what may make any result wrong, for the first lines of reports
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

// What an axis of a figure shows of a channel.

/// "acceleration [m/s2]"
inline std::string axis_label(Quantity quantity) {
  return std::string(to_string(quantity)) + " [" + si_unit(quantity) + "]";
}

/// "tip, acceleration"
inline std::string channel_title(const Channel& channel) {
  return (channel.name.empty() ? "" : channel.name + ", ") + to_string(channel.quantity);
}

// How the file of a record is to be read, and what is done with the record before anything else sees it.

/// One column of a record's file: by number, from 1, or by its name there.
struct ColumnDescription {
  Quantity quantity = Quantity::acceleration;
  std::string name;                     ///< in the header; empty when chosen by number
  int number = 0;                       ///< from 1; 0 when chosen by name
  double factor = 1;                    ///< to SI units
  std::optional<double> position = {};  ///< of the sensor or the force [m]; absent: the natural point
  double distance = 0.0;                ///< strain: of the surface from the axis [m]
  std::string place = {};               ///< by name, where places have names
  bool stated = true;                   ///< false: quantity and factor are what the file itself says
  double noise = 0.0;                   ///< standard deviation, in the column's unit; 0: not stated
  int file = 1;                         ///< of RecordFormat::files, from 1
};

/// What becomes of rows in which not every used column holds a number.
enum class MalformedRows {
  refuse,
  skip,       ///< left out, counted and located in the record's remarks
  as_missing  ///< cells that hold nothing, or say so, are samples that were not read; all else is refused
};

/// What becomes of samples that a measured input does not have.
enum class MissingInput {
  refuse,
  leave_out,  ///< the longest stretch in which every input is known is used
  zero        ///< no force acts there
};

/// How a record's file is to be read, and what is done with the record before anything else sees it.
struct RecordFormat {
  std::vector<std::string> files;  ///< of one record, a sensor or more each (read_record.cpp); empty: one
  std::string reader;              ///< registered; empty: the one that recognises the file
  char separator = '\0';  ///< '\0': the first of tab, semicolon, comma in the first row, else blanks (' ')
  int header_lines = 0;   ///< before the rows, the last non-blank one naming columns; 0 finds a single one
  char decimal = '\0';    ///< between whole and fraction, '.' or ','; '\0': what the first rows show
  MalformedRows malformed = MalformedRows::refuse;
  MissingInput missing_input = MissingInput::refuse;
  bool irregular = false;                 ///< take stamps as they are, at unequal intervals
  std::optional<ColumnDescription> time;  ///< factor to seconds
  std::optional<double> sampling_rate;  ///< [Hz]; replaces the printed times, counted from the first of them
  std::vector<ColumnDescription> channels;  ///< empty: the header's names tell quantities and units
  std::optional<InputPath> input;      ///< of force channels between samples; absent: as Record::input_path
  std::vector<std::string> own_clock;  ///< channels, by name or quantity, stamped by other clocks
  std::optional<std::pair<double, double>> window;  ///< [s]
  Place window_place;                               ///< where the window is set, for messages
  std::vector<Choice> preparation;                  ///< registered steps, in their order
};

// The unit of the times that a file states.

/// How many seconds a unit of time is, as a file spells it; an empty one is taken for the second.
/// @param what has it, for messages: "'/run/time'".
/// @returns nothing for another unit where the format states the times' unit or rate itself.
/// @throws InputError for another unit where it does not.
std::optional<double> seconds_per(const std::string& unit, const std::string& what, const std::string& file,
                                  const RecordFormat& format);

// Vibration records as delimited text that read_record() reads without being told how.

/// Comma-separated rows under a header that carries SI units: time_s, acceleration_m_per_s2, force_root_n.
///
/// @param digits significant ones; 0 for as many as reading back the same doubles takes.
/// @throws std::invalid_argument when times, samples and channels differ in number or hold NaN or infinity.
std::string to_csv(const Record& record, int digits = 0);

/// Writes to_csv() to a file, which appears whole or not at all.
/// @throws std::runtime_error when it cannot be written.
void write_record(const Record& record, const std::filesystem::path& file, int digits = 0);

// Where the channels of a record sit, as a TOML file beside it says.

/// The TOML file that belongs to a record: record.toml to record.csv, in the same folder.
std::filesystem::path places_file(const std::filesystem::path& record);

/// Positions and distances of the channels that have none, by the names of their columns, and how forces run
/// between samples, from places_file(); nothing where there is no such file, or its record.file names another
/// record.
/// @param columns of the channels, in their order; empty names match none
/// @throws InputError when the file is no valid TOML, or a value is impossible.
void take_places(const std::filesystem::path& file, const std::vector<std::string>& columns, Record& record);

/// The text of places_file(): `[record]` with a `[[record.channels]]` for every channel, SI units.
std::string places_text(const Record& record, const std::string& file_name);

}  // namespace beamid::experiments
