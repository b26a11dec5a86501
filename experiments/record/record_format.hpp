// How the file of a record is to be read, and what is done with the record before anything else sees it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/record.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::experiments {

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
  std::vector<std::string> files;  ///< of one record, a sensor or more each (joined_record.hpp); empty: one
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

}  // namespace beamid::experiments
