// Long texts, whose plain rows are read many at once, odd ones among them one by one.
// Oracle: the numbers, lines and places that were written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/record_table.hpp"
#include "filters/random.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::plain_rows_test {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// A text of three columns, and what it holds.
struct Written {
  std::string text;
  std::vector<std::vector<double>> rows;
  std::vector<std::size_t> lines;
};

/// @param odd share of the rows that are not plain
Written written(int rows, double odd, char separator, char decimal, const std::string& end, unsigned seed) {
  filters::RandomStream random(seed);
  const auto below = [&](double limit) { return limit * random.uniform(); };
  Written all;
  std::size_t line = 1;
  all.text = fmt::format("time_s{0}acceleration_m_per_s2{0}force_n{1}", separator, end);
  for (int k = 0; k < rows; ++k) {
    std::vector<double> values{1e-3 * k, std::round(below(2e4) - 1e4) / 1e4, std::round(below(900.0))};
    std::vector<std::string> cells;
    for (const double value : values) cells.push_back(fmt::format("{}", value));
    std::string after;
    const int kind = k > 2 && below(1.0) < odd ? static_cast<int>(below(8.0)) : -1;
    if (kind == 0) cells[1] = "nan", values[1] = missing;
    if (kind == 1) cells[1] = "\"" + cells[1] + "\"";
    if (kind == 2) cells[2] = "+" + cells[2];
    if (kind == 3) cells[1] = "  " + cells[1] + " ";
    if (kind == 4) after += separator;
    if (kind == 5) cells[1] = "OVERFLOW", values[1] = missing;
    if (kind == 6) all.text += end, ++line;
    if (kind == 7) all.text += "# a remark, 1, 2" + end, ++line;
    for (std::string& cell : cells) std::ranges::replace(cell, '.', decimal);
    all.text += fmt::format("{}{}{}", fmt::join(cells, std::string(1, separator)), after, end);
    all.rows.push_back(values);
    all.lines.push_back(++line);
  }
  return all;
}

void expect_as_written(const Written& all) {
  const TemporaryFile file("long.csv", all.text);
  const RecordTable table = read_table(file.path(), {});
  ASSERT_EQ(table.width(), 3U);
  ASSERT_EQ(table.rows(), all.rows.size());
  for (std::size_t row = 0; row < all.rows.size(); ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      const double value = table.columns[column][row], expected = all.rows[row][column];
      ASSERT_TRUE(value == expected || (std::isnan(value) && std::isnan(expected))) << row << ", " << column;
    }
    ASSERT_EQ(table.lines[row], all.lines[row]) << row;
  }
  for (std::size_t row = 0; row < all.rows.size(); row += 97) {
    const TextField cell = table.cell(row, 0);
    EXPECT_EQ(cell.place.line, all.lines[row]);
    EXPECT_EQ(cell.place.column, 1U);
    std::string text = cell.text;
    std::ranges::replace(text, ',', '.');
    EXPECT_EQ(text, fmt::format("{}", all.rows[row][0]));
  }
  EXPECT_DOUBLE_EQ(table.precision[2].resolution(all.rows[0][2]), 1.0);
}

TEST(PlainRows, AreReadAsTheyAreWritten) {
  for (const std::string end : {"\n", "\r\n"}) {
    expect_as_written(written(150'000, 0.0, ',', '.', end, 1));  // several blocks
    expect_as_written(written(20'000, 1e-3, ';', ',', end, 2));
    expect_as_written(written(20'000, 1e-3, '\t', '.', end, 3));
    expect_as_written(written(5'000, 0.3, ',', '.', end, 4));
  }
}

TEST(PlainRows, EndWhereARowIsShorter) {
  Written all = written(3000, 0.0, ',', '.', "\n", 5);
  all.text += "3.0,0.5\n3.001,0.5,1\n";
  const TemporaryFile file("long.csv", all.text);
  EXPECT_EQ(input_error_of(file, [&] { read_table(file.path(), {}); }),
            "long.csv:3002:1: 2 columns; expected 3 as in the first row");
}

}  // namespace
}  // namespace beamid::experiments::plain_rows_test
