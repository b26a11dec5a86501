// The fields of one line of delimited text, read and written: RFC 4180's quotes [rfc4180], any separator.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace beamid::experiments {

// Texts from outside, fit to be shown anywhere.

/// The text in UTF-8 and on one line, without anything that a terminal, a page, a table or a plot takes for a
/// command: control characters (U+0000 to U+001F, U+007F to U+009F) and those that XML forbids are dropped;
/// tabs and line breaks become blanks. A byte that is not UTF-8 is taken for ISO 8859-1, in which loggers
/// write "m/s²".
std::string clean_text(std::string_view text);

/// The same with its line breaks: for what is printed as a whole.
std::string clean_lines(std::string_view text);

/// Where the first control character, a tab or a line break too, begins; npos: nowhere.
std::size_t find_control(std::string_view text);

/// The first line of a text, which LF, CRLF or CR ends, without its end. @param rest what is behind it then
std::string_view take_line(std::string_view& rest);

/// Without blanks and tabs around it.
std::string_view trimmed(std::string_view text);

/// The text of a field that split_fields() found: of one in quotes, what is between them, with doubled ones
/// as one.
std::string field_text(std::string_view field);

/// The same, or without one pair of single quotes around it.
std::string unquoted(std::string_view field);

/// The first of tab, semicolon, |, comma that occurs, else ' ' for blanks.
char separator_of(std::string_view line);

/// The trimmed fields of a line, views into it. ' ' stands for any run of blanks and tabs. A separator
/// between quotes is none: such a field comes without them, or, where quotes are doubled in it, with them,
/// for field_text(). A quote that is not closed before the next separator or the end is text like any other.
/// @param empty_ends whether empty fields at the end of the line count
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields,
                  bool empty_ends = false);

/// A text, cleaned, as a basic string of TOML with its quotes.
std::string toml_string(std::string_view text);

/// A text, cleaned (fields.hpp), as a field that split_fields() and field_text() give back: quoted where
/// it holds a comma, a quote or a line break, or begins or ends with a blank.
std::string csv_field(std::string_view text);

/// The shortest decimal number that reads back as the same double; empty when it is NaN.
std::string csv_field(double value);

/// Name of a column: "stiffness" in "N/m" is "stiffness_n_per_m", of no unit "stiffness".
std::string column_key(const std::string& name, const std::string& unit);

struct ParsedNumber {
  double value = 0;
  bool number = false;  ///< the whole field reads as a number, NaN and infinity included
  bool finite = false;  ///< and a double can hold it
};

/// A decimal number with a point, in whatever locale: -1, +.5, 2.5E-3, or Fortran's 2.5D-3.
ParsedNumber parse_number(std::string_view field);

/// The same with `decimal` between whole and fraction, '.' or ','.
ParsedNumber parse_number(std::string_view field, char decimal);

/// Whether a cell says that nothing was read: it is empty, or NaN, NA, null, OVERFLOW, - or the like.
bool says_missing(std::string_view field);

/// Length of the label of "ax: 0.25" or "ax=0.25" with its sign; 0 without one.
std::size_t label_length(std::string_view field);

/// The words of a header whose columns stand under each other: parted by two blanks at least.
std::vector<std::string_view> parted_by_blanks(std::string_view line);

bool holds_number(const std::vector<std::string_view>& fields, char decimal = '.');
bool all_numbers(const std::vector<std::string_view>& fields, char decimal = '.');

}  // namespace beamid::experiments
