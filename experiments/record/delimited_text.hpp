// Rows of numbers in a text file: separators, header, places.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/record/record_table.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

/// Whether a field is a number with either decimal sign, or a date or time.
bool is_reading(std::string_view field);
bool holds_reading(const std::vector<std::string_view>& fields);
/// Whether all are, or, with gaps, say that nothing was read: one at least is.
bool is_row(const std::vector<std::string_view>& fields, bool with_gaps);
/// Two cells, a key and its value: "Sample Rate,1000", "Gain,2.0", "Units,g".
bool is_key_and_value(const std::vector<std::string_view>& fields);

/// What a first cell says of those behind it, one for each column: "TraceName","CH1" or "Y unit","g".
enum class KeyInFront { none, names, units };
KeyInFront key_in_front(const std::vector<std::string_view>& fields, std::size_t width);
/// Components of a sensor that is named and has its unit once, as cameras write them: "Accelerometer [m/s2]",
/// "1", "2".
bool numbers_components(const std::vector<std::string_view>& fields);
/// Numbers of components become names with the unit: "1: Accelerometer [m/s2]".
void name_components(std::vector<std::string>& names);

/// The first line that is not blank behind a place of the text, 0 to 1: where its rows are.
std::string_view line_near(std::string_view text, double place);

/// Whether every one of several lines across the text fulfils it: what holds for its rows, whatever is above.
bool holds_across(std::string_view text, const std::function<bool(std::string_view)>& fulfilled);

/// The lines of a text, ended by LF or CRLF, without their ends.
inline std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    lines.push_back(line.ends_with('\r') ? line.substr(0, line.size() - 1) : line);
  }
  return lines;
}

/// Walks through the rows of a delimited text.
///
/// Blank lines and comment lines (#, %, !, // first, or ; where it parts no columns) are passed over, lines
/// end with LF, CRLF or CR. The rows begin with the first two lines in succession that are equally long and
/// hold nothing but numbers, stamps and words for what is missing. Their names stand in one of the four lines
/// of words before them that has as many fields, the nearest that names a quantity or a time, their units in
/// the line below; or, where the rows come first, in a comment. Lines of words before the names are passed
/// over. A first row that holds words beside its numbers begins the rows too. Where fields carry their names
/// ("ax: 0.25"), those are the names.
///
/// With `header_lines`, the names come from the last non-blank of them. A line that repeats the header, and
/// lines of words behind the last row, are left out and remembered. Cells at the end of a row that hold
/// nothing count where the row has its separators.
///
/// A tolerant walk begins at the first two rows in succession that are numbers throughout and equally long.
/// The lines before them that hold as many fields and no number name the columns and then their units; rows
/// of another length are left out and remembered. So is a last line that is shorter, as where a logger was
/// switched off.
class DelimitedText {
 public:
  /// @param text must outlive this object.
  /// @param separator '\0' for the first of tab, semicolon, comma that the first row of numbers shows, else
  /// blanks;
  ///        ' ' for any run of blanks and tabs.
  /// @param decimal '.' or ','; '\0' for a comma where the first rows show commas and no point.
  /// @throws InputError when there is no row of numbers.
  DelimitedText(std::string file, std::string_view text, char separator, int header_lines, char decimal = '.',
                bool tolerant = false);

  const std::string& file() const { return file_; }
  const std::vector<std::string>& names() const {
    return names_;
  }  ///< of the columns; empty when they have none
  const std::vector<std::string>& units() const { return units_; }  ///< likewise
  char separator() const { return separator_; }
  char decimal() const { return decimal_; }
  const std::vector<std::size_t>& skipped_lines() const { return skipped_; }  ///< that were left out
  std::size_t header_line() const { return header_line_; }  ///< where the names stand; 0 without
  std::size_t width() const { return width_; }              ///< columns of the first row of numbers

  /// The next row. @returns false at the end.
  /// @throws InputError when it has not width() columns, unless the walk is tolerant.
  bool next();

  /// Reads on, many rows at once, up to the first that is not plain: numbers alone in all columns, parted by
  /// nothing but the separator and blanks (plain_rows.cpp). What next() would say of these rows is added to
  /// the table and its cells.
  void take_plain_rows(RecordTable& table, TextCells& cells);

  Place place(std::size_t column) const;  ///< of a field of this row; columns count from 0
  Place row_place() const { return {file_, line_number_, 1}; }
  std::string_view line() const { return line_; }
  std::size_t line_number() const { return line_number_; }
  std::string_view field(std::size_t column) const { return fields_[column]; }

  /// NaN where the field is no finite number.
  double value(std::size_t column) const;
  /// @throws InputError where it is none.
  double number(std::size_t column) const;

  /// Of a last line that is shorter than the others; empty without one.
  const std::vector<double>& short_end() const { return short_end_; }

 private:
  static constexpr std::size_t most_early_lines = 20000;

  struct EarlyLine {
    std::string_view text;
    std::size_t number, width;
    bool rows;  ///< numbers throughout, or, failing that, somewhere
  };

  /// The plain rows of a length of the text. @returns how many
  std::size_t take_plain_stretch(RecordTable& table, TextCells& cells, std::size_t length);
  void go_back_to(const EarlyLine& line, std::string_view text);  ///< as the line that was read last

  class Body;

  struct Comment {
    std::string_view text;
    std::size_t line;
  };

  bool next_line();                    ///< of any kind
  bool next_row();                     ///< passes over blank lines and comments, remembering the first ones
  void find_header(int header_lines);  ///< and the first row after it
  void find_rows();                    ///< the same of a tolerant walk
  bool find_body();                    ///< the same by two rows in succession; false: there are none
  void choose_separator();             ///< and the decimal sign, by the first rows
  void refuse_commas_between_commas() const;
  void split(std::string_view line);  ///< while the separator is open
  void split_row();                   ///< of this line, with cells at its end that hold nothing
  void take_labels();                 ///< from the fields
  void take_comment();                ///< as names, where one names the columns
  void name_columns(std::string_view header, std::size_t line);
  std::vector<std::string_view> named(std::string_view line, std::size_t width) const;  ///< its fields
  /// With a date and a time below its first name, as receivers of GNSS write them.
  std::vector<std::string_view> named_with_date(std::string_view line) const;
  bool is_comment(std::string_view content) const;
  std::string_view words_of_comment(std::string_view comment) const;
  bool only_words_follow() const;  ///< from this line on

  std::string file_;
  std::string_view rest_, line_, header_text_;
  std::size_t line_number_ = 0, header_line_ = 0, width_ = 0;
  char separator_, decimal_;
  bool tolerant_;
  std::vector<std::size_t> skipped_;
  std::vector<double> short_end_;
  std::vector<Comment> comments_;  ///< before the first row
  bool semicolon_comments_ = false, labelled_ = false;
  bool first_row_pending_ = false;
  std::ptrdiff_t pause_ = 0, next_pause_ = 0;  ///< rows that are read one by one before many are tried
  std::vector<std::string_view> fields_;
  std::vector<std::string> names_, units_;
};

/// A word in a row: no number, none with a unit behind it, and no time; but a number in hexadecimal digits.
bool is_word(std::string_view field);

/// A column of words that name the sensors of its rows, each in rows of its own, as numbers from 1.
struct SensorRows {
  std::size_t column;
  std::vector<std::string> tags;  ///< their names
};

/// Stamps parted from their rows, labels joined with their numbers, words beside numbers blanked, one of
/// several sensors kept (written_text.cpp), or their names as numbers.
/// @throws InputError where none of these measures accelerations
std::optional<SensorRows> bring_to_fields(const std::string& file, const RecordFormat& format,
                                          std::string& text);

/// Words in a column that name a few sensors of as many rows each become numbers in place.
std::optional<SensorRows> number_sensors(std::string& text);

/// Rows of the same words and signs around their numbers become fields with labels; lines stay lines.
void bring_pattern_to_fields(std::string& text);

/// Rows of several sensors, of the same times, become channels side by side.
/// @param tagged of number_sensors(); absent: a column named for sensors
/// @throws InputError where each has times of its own
void part_sensors(RecordTable& table, const std::optional<SensorRows>& tagged);

/// A text in Windows-1251, by its words of Cyrillic letters, becomes UTF-8.
void bring_to_utf8(std::string& text);

/// A few long lines, a channel each, become columns. @returns whether they were such
bool turn_lines_to_columns(std::string& text);

/// Times from parts of a clock in columns of their own, blocks of rows side by side, names of solutions of
/// GNSS that have none (record_table.cpp). @throws InputError where blocks have other times than the first
void bring_in_order(RecordTable& table);

/// A first row of one time of day for all columns, in seconds since 1970, and a second of one rate: the form
/// of a wristband (plain_rows.cpp).
void take_start_and_rate(RecordTable& table);

/// Rows that go on from one to the next become one column (plain_rows.cpp).
/// @param above lines above the rows; @param last numbers of a last row that is shorter
void join_rows_that_go_on(RecordTable& table, std::string_view above, const std::vector<double>& last);

/// The columns of a delimited text, dates and times of day as numbers of seconds.
/// @param file for messages. @throws InputError at a row, or where there is none.
RecordTable table_of_text(const std::string& file, std::string content, const RecordFormat& format);

/// A quantity of motion, with the factor to its SI unit.
using MotionUnit = std::pair<Quantity, double>;

/// Spellings of networks beside those of stated_unit(), without the library of units, which may be missing:
/// "CM/SEC/SEC", "cm/seg2", "G/10", "%g", "m.s-2".
std::optional<MotionUnit> motion_unit(std::string_view written);

/// Sets RecordTable::stated_unit by the lines above the rows (stated_unit.cpp). Its factor is NaN, and a
/// warning says why, where these lines name a unit and the columns may be in another: a question where nobody
/// states it.
/// @param described whether the channels are stated elsewhere
void take_stated_unit(RecordTable& table, std::string_view above, bool described);

}  // namespace beamid::experiments
