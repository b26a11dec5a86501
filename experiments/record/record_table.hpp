// What every kind of record file comes to: named columns of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/record/record.hpp"
#include "experiments/text/input_error.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

// Are printed times those of a regularly sampled record?

/// How finely a column of numbers was printed: by its decimals or by its significant digits, whichever is
/// coarser.
class PrintedPrecision {
 public:
  void add(std::string_view token);
  void add(const PrintedPrecision& other);  ///< of more numbers of the column

  /// That of numbers of so many significant digits: 7 in single precision, 15 in double.
  static PrintedPrecision of_digits(int digits);

  /// Distance between neighbouring printable numbers near `value`, in the column's unit.
  double resolution(double value) const;

 private:
  int decimals_ = -400, digits_ = 1;
};

/// A time that does not fit a regularly sampled record.
struct SamplingFault {
  std::size_t sample;   ///< whose time is at fault
  std::string message;  ///< what was found and what was expected
};

/// Rows that a file lacks: intervals that are whole multiples of the usual one, of which at least one is
/// longer than any rounding of printed times makes it. Times printed to whole intervals, as 0.01 s at 100 Hz,
/// lengthen one by their last digit: more than one such in a hundred rows is a rounding.
struct MissingRows {
  std::size_t rows = 0, places = 0;     ///< in all
  std::size_t longest = 0, before = 0;  ///< rows in a row, and the row behind them
};
std::optional<MissingRows> find_missing_rows(const std::vector<double>& times,
                                             const PrintedPrecision& precision);

/// The first time that does not follow its predecessor, or does at an interval more than 5 % from the median
/// interval that the rounding of printed times does not explain. Rounding coarser than half an interval
/// explains nothing, as it would hide a missing sample. The filters take one sampling interval. Missing rows
/// are named as such, where most are missing in a row.
///
/// @param times as printed, in the file's unit, in which the message speaks too.
std::optional<SamplingFault> find_sampling_fault(const std::vector<double>& times,
                                                 const PrintedPrecision& precision);

/// The first time that is not after its predecessor: all that is asked of stamps at unequal intervals.
std::optional<SamplingFault> find_order_fault(const std::vector<double>& times);

/// Equal intervals that a file states instead of stamps.
struct Clock {
  double start = 0.0;     ///< [s]
  double interval = 0.0;  ///< [s]
};

/// Lines of a file in which rows stand, by runs of lines that follow each other.
class RowLines {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t operator[](std::size_t row) const;  ///< from 1; @param row of fewer than size(), from 0
  void clear() { runs_.clear(), size_ = 0; }
  void keep(const std::vector<bool>& kept);

  /// So many rows in lines from this one on. @returns whether they do not go on from the row before
  bool add(std::size_t line, std::size_t count = 1);

 private:
  struct Run {
    std::size_t row, line;  ///< its first
  };
  std::vector<Run> runs_;
  std::size_t size_ = 0;
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
  std::optional<std::pair<Quantity, double>> stated_unit;  ///< likewise, of all columns but time; to SI units
  std::size_t header_line = 0;                             ///< where the names stand; 0 where unknown
  RowLines lines;                                          ///< of the rows; empty in binary files
  std::vector<std::size_t> skipped_lines;  ///< left out already, as they have another number of columns
  std::function<TextField(std::size_t row, std::size_t column)> cell;  ///< absent in binary files
  std::vector<std::string> remarks;                                    ///< sentences for reports
  std::vector<std::string> warnings;                                   ///< what may make any result wrong

  std::size_t width() const { return columns.size(); }
  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }

  /// Of a row from 0: the line in which it stands, or its number from 1.
  std::size_t line_of(std::size_t row) const { return row < lines.size() ? lines[row] : row + 1; }

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

// Readers of record files, found by name or by what a file begins with.

/// One kind of file; each is one file under record_files/ that registers itself.
class RecordReader {
 public:
  virtual ~RecordReader() = default;

  /// @param beginning of the file, at most 1024 bytes.
  virtual bool recognises(std::string_view beginning) const = 0;

  /// All columns of numbers.
  /// @param format where it speaks of separators, header lines and the like.
  /// @throws InputError naming the place as finely as the kind of file allows.
  virtual RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const = 0;
};

using RecordReaderRegistry = filters::Registry<RecordReader>;
RecordReaderRegistry& record_reader_registry();

/// The reader that `format` names, else the one that recognises the file, else delimited text, which is also
/// meant wherever the format states header lines or a separator.
/// @throws InputError when there is no such file, std::invalid_argument when there is no such reader.
std::string reader_of(const std::filesystem::path& file, const RecordFormat& format);

/// The file's columns, by reader_of(), with names and units cleaned (fields.hpp). @throws InputError.
RecordTable read_table(const std::filesystem::path& file, const RecordFormat& format);

// Binary files of either byte order.

/// @param bytes sizeof(Number) of them. @param swapped in the order that is not this machine's
template <class Number>
Number number_of_bytes(const char* bytes, bool swapped) {
  char parts[sizeof(Number)];
  std::memcpy(parts, bytes, sizeof parts);
  if (swapped) std::reverse(std::begin(parts), std::end(parts));
  Number value;
  std::memcpy(&value, parts, sizeof value);
  return value;
}

// Where the fields of rows of text stand, found again when a message needs it.

/// Keeps a text and where every sixteenth of its rows begins, at least: one byte a row.
class TextCells {
 public:
  TextCells(std::string file, std::shared_ptr<const std::string> text);

  /// Rows in lines that follow each other.
  /// @param line the first, a view into the text; @param number its line's, from 1; @param count at most 16
  void add(std::string_view line, std::size_t number, std::size_t count = 1);

  static constexpr std::size_t most_rows = 16;  ///< between one mark and the next

  /// @param columns of the text that the table's columns are, from 0; empty: the same ones.
  std::function<TextField(std::size_t, std::size_t)> cells(char separator,
                                                           std::vector<std::size_t> columns = {}) const;

 private:
  struct Mark {
    std::size_t row, begin;  ///< of the text
  };
  struct Rows {
    std::string file;
    std::shared_ptr<const std::string> text;
    RowLines lines;
    std::vector<Mark> marks;

    std::string_view line(std::size_t row) const;
  };
  std::shared_ptr<Rows> rows_;
};

}  // namespace beamid::experiments
