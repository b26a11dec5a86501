#include "experiments/results/table.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/results.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments::table_test {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN();

std::string printed(const Table& table) {
  std::ostringstream stream;
  print(stream, table);
  return stream.str();
}

std::size_t widest_line(const std::string& text) {
  std::istringstream stream(text);
  std::size_t width = 0;
  for (std::string line; std::getline(stream, line);) width = std::max(width, width_of(line));
  return width;
}

Table small_table() {
  Table table{"table1", "Table 1. Modal analysis", {}, "Damping ratios are assumed."};
  table.column({"beam", "beam"})
      .column({"f1 [Hz]", "frequency_hz", "{:.4f}"})
      .column({"ξ [%]", "damping_ratio_percent", "{:.2f}"});
  return table.row({"S(0.65)", 4.145510989755, 0.2}).row({"S(119.3)", 1.729901652424, nan});
}

// As wide as the table of a whole study gets: five beams by two filters by two discretisations.
Table wide_table() {
  Table table{"table3", "Table 3. Parameters identified from the processed acceleration"};
  table.column({"beam", "beam"})
      .column({"filter", "filter"})
      .column({"discretisation", "discretisation"})
      .column({"K [N/m]", "stiffness_n_per_m", "{:.3f}"})
      .column({"s(K) [N/m]", "stiffness_standard_deviation_n_per_m", "{:.4f}"})
      .column({"C [N s/m]", "damping_n_s_per_m", "{:.5f}"})
      .column({"s(C) [N s/m]", "damping_standard_deviation_n_s_per_m", "{:.5f}"})
      .column({"damping ratio [%]", "damping_ratio_percent", "{:.4f}"})
      .column({"error of K [%]", "stiffness_error_percent", "{:+.4f}"})
      .column({"error of C [%]", "damping_error_percent", "{:+.3f}"})
      .column({"predicted error of C [%]", "predicted_damping_error_percent", "{:+.3f}"});
  for (const char* beam : {"S(0.65)", "S(11.8)", "S(43.8)", "S(76.3)", "S(119.3)"})
    for (const char* filter : {"EKF", "UKF"})
      for (const char* scheme : {"forward Euler", "exponential"})
        table.row(
            {beam, filter, scheme, 501.2341, 0.01234, 0.258123, 0.000123, 0.2, -0.01091, 650.1234, 651.2});
  return table;
}

// Oracle: written by hand. "ξ" takes two bytes and one column.
TEST(Table, PrintsNumbersToTheRightTextsToTheLeftAndNanAsDash) {
  EXPECT_EQ(printed(small_table()),
            "Table 1. Modal analysis\n"
            "beam      f1 [Hz]  ξ [%]\n"
            "--------  -------  -----\n"
            "S(0.65)    4.1455   0.20\n"
            "S(119.3)   1.7299      -\n"
            "Damping ratios are assumed.\n");
}

TEST(Table, PrintsNoSignOfWhatIsPrintedAsZero) {
  Table table{"errors", ""};
  table.column({"e", "error", "{:+.2f}"}).column({"d", "difference", "{:.2f}"}).column({"l", "limit"});
  table.row({-1e-9, -0.004, -0.0}).row({1e-9, -0.006, -std::numeric_limits<double>::infinity()});
  EXPECT_EQ(printed(table),
            "   e      d     l\n"
            "----  -----  ----\n"
            "0.00   0.00     0\n"
            "0.00  -0.01  -inf\n");
}

// Oracle: written by hand. Units in brackets stay in one piece.
TEST(Table, BreaksHeadingsBeforeAnythingElse) {
  Table table{"wide", ""};
  for (int i = 0; i < 9; ++i) table.column({"long heading [N s/m]", "key", "{:.1f}", {1.0}});
  const std::string text = printed(table);
  EXPECT_LE(widest_line(text), page_width);
  EXPECT_NE(text.find("heading\n"), std::string::npos) << text;
  EXPECT_NE(text.find("[N s/m]"), std::string::npos) << text;
}

// Oracle: the width of the page, and every heading and row is there.
TEST(Table, TheWidestTableOfAStudyStaysOnThePage) {
  const std::string text = printed(wide_table());
  EXPECT_LE(widest_line(text), page_width) << text;
  EXPECT_NE(text.find("+651.200"), std::string::npos);
  EXPECT_NE(text.find("+650.123"), std::string::npos);
  // The second block repeats beam, filter and discretisation.
  EXPECT_NE(text.find("S(119.3)  UKF     exponential", text.find("+651.200")), std::string::npos) << text;
}

// Oracle: every row of every block begins with the numbers that say which row it is.
TEST(Table, RepeatsAllColumnsThatTellItsRowsApart) {
  Table table{"summary", ""};
  table.column({"ratio", "ratio", "{:g}"}).column({"noise", "noise_m", "{:g}"}).column({"method", "method"});
  for (int i = 0; i < 8; ++i) table.column({"some quantity", "key", "{:.6f}"});
  for (const double ratio : {0.001, 0.01})
    for (const double noise : {1e-5, 1e-4})
      for (const char* method : {"ekf", "ukf"})
        table.row({ratio, noise, method, 1., 2., 3., 4., 5., 6., 7., 8.});
  std::ostringstream stream;
  print(stream, table, Page{60, false});
  const std::string text = stream.str();
  EXPECT_LE(widest_line(text), 60u) << text;
  std::size_t blocks = 0, keyed = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    blocks += line.starts_with("-");
    keyed += line.find(" 0.0001  ukf ") != std::string::npos;
  }
  EXPECT_GE(blocks, 2u);
  EXPECT_EQ(keyed, 2 * blocks) << text;
}

TEST(Table, FillsAWidePage) {
  std::ostringstream stream;
  print(stream, wide_table(), Page{200, false});
  EXPECT_GT(widest_line(stream.str()), 120u);
  EXPECT_EQ(stream.str().find("\n\n"), std::string::npos) << "one block";
}

// Oracle: the width of the page, and no word is lost.
TEST(Table, BreaksLongTexts) {
  Table table{"filters", ""};
  std::string words;
  for (int i = 0; i < 40; ++i) words += "word ";
  table.column({"name", "name"}).column({"summary", "summary"}).row({"ekf", words}).row({"ukf", "short"});
  const std::string text = printed(table);
  EXPECT_LE(widest_line(text), page_width) << text;
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find("word", at)) != std::string::npos; ++at) ++count;
  EXPECT_EQ(count, 40u);
}

// Oracle: RFC 4180, sections 2.5 to 2.7.
TEST(Csv, QuotesFieldsThatHoldCommasQuotesOrLineBreaks) {
  Table table{"csv", ""};
  table.column({"a", "plain"}).column({"b", "with,comma"}).row({"say \"so\"", "two\nlines"}).row({"x", 1.5});
  EXPECT_EQ(to_csv(table), "plain,\"with,comma\"\n\"say \"\"so\"\"\",\"two\nlines\"\nx,1.5\n");
}

// The reader of records and journals against the writer of tables. Oracle: [rfc4180], sections 2.5 to 2.7.
TEST(Csv, FieldsReadBackAsTheyWereWritten) {
  const std::vector<std::string> texts{"plain", "with,comma", "say \"so\", please", " blanks ",
                                       "",      "\"\"",       "'single'",           "5\" pipe"};
  std::string line;
  for (const std::string& text : texts) line += (line.empty() ? "" : ",") + csv_field(text);
  std::vector<std::string_view> fields;
  split_fields(line, ',', fields);
  ASSERT_EQ(fields.size(), texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) EXPECT_EQ(field_text(fields[i]), texts[i]);
  split_fields("1, \"2;5\" ,\"open,3,,", ',', fields, true);
  EXPECT_EQ(fields, (std::vector<std::string_view>{"1", "2;5", "\"open", "3", "", ""}));
  split_fields("\"time s\"  \"a, g\"", ' ', fields);
  EXPECT_EQ(fields, (std::vector<std::string_view>{"time s", "a, g"}));
}

// Oracle: strtod gives back the same double; NaN is an empty field.
TEST(Csv, NumbersReadBackTheSame) {
  const std::vector<double> values{0.1, 1.0 / 3.0, -2.5e-310, 6.02214076e23, 1.0, -0.0};
  Table table{"csv", ""};
  table.column({"value", "value", "{:.1f}"}).column({"missing", "missing", "{}"});
  for (const double value : values) table.row({value, nan});
  std::istringstream csv(to_csv(table));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "value,missing");
  for (const double value : values) {
    std::getline(csv, line);
    ASSERT_EQ(line.back(), ',');
    EXPECT_EQ(std::strtod(line.c_str(), nullptr), value) << line;
  }
}

TEST(Table, NamesTheColumnThatIsTooShort) {
  Table table{"table1", ""};
  table.column({"a", "first", "{}", {1.0, 2.0}}).column({"b", "second", "{}", {1.0}});
  try {
    to_csv(table);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "table 'table1': column 'second' has 1 cells; expected 2");
  }
  EXPECT_THROW(table.row({1.0}), std::invalid_argument);
}

// Oracle: ECMA-48, SGR 1, 31 and 0.
TEST(Text, EmphasisesVerdictsWhereThereAreColours) {
  const Page coloured{100, true};
  EXPECT_EQ(emphasised("DIVERGED: no.", coloured), "\033[1;31mDIVERGED\033[0m: no.");
  EXPECT_EQ(emphasised("See: THE RECORDS DISAGREE by", coloured),
            "See: \033[1;31mTHE RECORDS DISAGREE\033[0m by");
  EXPECT_EQ(emphasised("an UNDIVERGED one, DIVERGEDX", coloured), "an UNDIVERGED one, DIVERGEDX");
  EXPECT_EQ(emphasised("DIVERGED: no.", Page()), "DIVERGED: no.");
}

TEST(Text, WrapsAtBlanksAndIndentsListItems) {
  EXPECT_EQ(wrapped("one two three", 8), (std::vector<std::string>{"one two", "three"}));
  EXPECT_EQ(wrapped("- one two three", 9), (std::vector<std::string>{"- one two", "  three"}));
  EXPECT_EQ(wrapped("  kept   as it is\n\nlast", 20),
            (std::vector<std::string>{"  kept   as it is", "", "last"}));
  EXPECT_EQ(wrapped("unbreakable", 4), (std::vector<std::string>{"unbreakable"}));
}

// Oracle: two significant digits of the uncertainty, counted by hand.
TEST(Table, RoundsForPeopleAndNotForPrograms) {
  const auto text = [](double value, double uncertainty) { return rounded_text({value, uncertainty}); };
  EXPECT_EQ(text(3.455518812, 0.00008), "3.455519");
  EXPECT_EQ(text(3.455518812, 0.012), "3.456");
  EXPECT_EQ(text(210333.0, 4100.0), "210333");
  EXPECT_EQ(text(2.0712e11, 3.2e8), "2.0712e+11");
  EXPECT_EQ(text(0.000001234567, 3e-9), "1.2346e-06");
  EXPECT_EQ(text(-0.0001, 0.2), "0.00");
  EXPECT_EQ(text(509.38971, 0.0), "509.39");
  EXPECT_EQ(text(nan, 0.1), "-");
  Table table{"modes", ""};
  table.column({"f [Hz]", "frequency_hz"}).row({Rounded{3.455518812, 0.012}}).row({Rounded{nan, nan}});
  EXPECT_EQ(to_csv(table), "frequency_hz\n3.455518812\n\n");
}

}  // namespace
}  // namespace beamid::experiments::table_test
