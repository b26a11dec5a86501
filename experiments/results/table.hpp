// A table that is printed for a person and written as CSV for a program.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

namespace beamid::experiments {

/// A number that a person sees to two digits of its uncertainty, and a program whole.
struct Rounded {
  double value = 0.0;
  double uncertainty = 0.0;  ///< standard deviation or half interval, in the value's unit; not > 0: not known

  bool operator==(const Rounded&) const = default;
};

using Cell = std::variant<double, std::string, Rounded>;

/// What a program reads of a cell that is no text, else null.
const double* number_of(const Cell& cell);

/// One column of a table, for the terminal and for CSV.
struct Column {
  std::string heading;        ///< on the terminal, short, unit in brackets: "f1 [Hz]"
  std::string key;            ///< in the CSV header, unit as suffix: "frequency_hz"
  std::string format = "{}";  ///< of a number on the terminal: "{:.4f}"
  std::vector<Cell> cells = {};
};

/// Built column by column, or from headings and then row by row:
///
///     Table table{"table1", "Table 1. Modal analysis"};
///     table.column({"beam", "beam"}).column({"f1 [Hz]", "frequency_hz", "{:.4f}"});
///     table.row({"S(0.65)", 4.1455}).row({"S(11.8)", 3.4555});
struct Table {
  std::string name;   ///< of its file, without ".csv"
  std::string title;  ///< above it; may be empty
  std::vector<Column> columns = {};
  std::string note = {};  ///< below it; may be empty

  Table& column(Column column);

  /// @throws std::invalid_argument unless there is one cell for each column.
  Table& row(std::vector<Cell> cells);

  /// @throws std::invalid_argument when the columns differ in length.
  std::size_t rows() const;
};

/// The table aligned, numbers to the right, texts and rounded numbers to the left, NaN as "-".
///
/// Never wider than page_width: headings break at blanks first, then the widest columns of texts, and columns
/// that still do not fit follow below, with the leading columns of texts repeated.
/// @throws std::invalid_argument when the columns differ in length or a format does not suit a number.
void print(std::ostream& stream, const Table& table);

/// Header of keys, then one line per row; numbers as the shortest text that reads back the same, NaN as
/// nothing. Quoting as in [rfc4180]; lines end in "\n", as the text tools of Unix expect.
/// @throws std::invalid_argument when the columns differ in length.
std::string to_csv(const Table& table);

}  // namespace beamid::experiments
