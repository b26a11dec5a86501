// What every kind of record file comes to: named columns of numbers.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/record/sampling.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

/// Equal intervals that a file states instead of stamps.
struct Clock {
  double start = 0.0;     ///< [s]
  double interval = 0.0;  ///< [s]
};

/// One field of a text file.
struct TextField {
  Place place;
  std::string text;  ///< as it stands there
};

/// Columns of equally many numbers, in the file's own units.
struct RecordTable {
  std::string file;
  std::vector<std::string> names;  ///< of the columns; empty where the file gives none
  std::vector<std::string> units;  ///< of the columns, as the file spells them; empty where it gives none
  bool by_people = false;          ///< names are as people write them, or none: what they say is recognised
  std::vector<std::vector<double>> columns;  ///< NaN where the file holds no finite number
  std::vector<PrintedPrecision> precision;   ///< of the columns: how finely they were written
  std::optional<std::size_t> time;           ///< the column of time [s], where the format knows one by itself
  std::optional<Clock> clock;                ///< where the format states one
  std::optional<double> stated_rate;         ///< in words above the columns, for files without stamps [Hz]
  std::size_t header_line = 0;               ///< where the names stand; 0 where unknown
  std::vector<std::size_t> lines;            ///< of the rows; empty in binary files
  std::vector<std::size_t> skipped_lines;    ///< left out already, as they have another number of columns
  std::function<TextField(std::size_t row, std::size_t column)> cell;  ///< absent in binary files
  std::vector<std::string> remarks;                                    ///< sentences for reports
  std::vector<std::string> warnings;                                   ///< what may make any result wrong

  std::size_t width() const { return columns.size(); }
  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }

  /// Of a value, or of the file where nothing finer is known.
  Place place(std::size_t row, std::size_t column) const;
  Place row_place(std::size_t row) const;

  /// What is wrong with a value that is not finite, at its place.
  InputError fault(std::size_t row, std::size_t column) const;

  /// Leaves rows out.
  void keep(const std::vector<bool>& kept);
};

/// What is wrong with a field that is no finite number. @param column from 0.
InputError number_fault(const TextField& found, std::size_t column);

/// "1 column", "4 columns", for messages.
std::string count_of_columns(std::size_t count);

/// "1 line is left out, as ...: 9." or "12 lines are left out, as ...: 4, 7, 9, ...": nothing when there are
/// none. @param why "they hold no numbers".
std::string skipped_text(const std::vector<std::size_t>& lines, const std::string& why);

}  // namespace beamid::experiments
