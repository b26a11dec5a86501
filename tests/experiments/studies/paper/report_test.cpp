// What is printed and written as tables. Oracles: the page's width, and CSV's rule of one field per column.
#include "experiments/studies/paper/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "experiments/results/text.hpp"
#include "tests/experiments/studies/paper/shared_outcome.hpp"

namespace beamid::experiments::paper::report_test {
namespace {

Results finding() {
  Results results;
  add_finding(test::outcome(), results);
  return results;
}

// Fields of a line of CSV; commas between quotes separate nothing.
int fields_of(const std::string& line) {
  bool quoted = false;
  int fields = 1;
  for (const char c : line) {
    quoted ^= c == '"';
    fields += c == ',' && !quoted;
  }
  return fields;
}

TEST(PaperReport, FitsThePage) {
  std::ostringstream stream;
  print(stream, finding());
  std::istringstream lines(stream.str());
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_LE(width_of(line), page_width) << line;
  EXPECT_GT(count, 100);
}

TEST(PaperReport, HasItsTablesAsFilesWithUnitsInTheirHeaders) {
  std::set<std::string> names;
  for (const auto& part : finding().report) {
    const auto* table = std::get_if<Table>(&part);
    if (!table) continue;
    EXPECT_TRUE(names.insert(table->name).second) << table->name << " is there twice";
    std::istringstream lines(to_csv(*table));
    std::string header;
    ASSERT_TRUE(std::getline(lines, header));
    EXPECT_TRUE(std::regex_match(header, std::regex("[a-z0-9_,]+"))) << header;
    std::size_t rows = 0;
    for (std::string line; std::getline(lines, line); ++rows)
      EXPECT_EQ(fields_of(line), fields_of(header)) << table->name << ": " << line;
    EXPECT_EQ(rows, table->rows()) << table->name;
    for (const Column& column : table->columns)  // a unit on the terminal is a unit in the file
      EXPECT_EQ(column.heading.ends_with("[%]"), column.key.ends_with("_percent"))
          << table->name << ": " << column.key;
  }
  for (const char* name : {"table_1", "table_2", "table_3", "table_4", "table_5", "discretisation_bias"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(PaperReport, SaysWhatIsAssumedAndHowItWasSet) {
  // Oracle: what a reader must be told beside the numbers.
  std::ostringstream stream;
  print(stream, finding());
  std::string text = std::regex_replace(stream.str(), std::regex("\\s+"), " ");
  for (const char* said : {"assumed", "0.13 %", "6.41 %", "K0 = 0.8 K", "P0 = diag(", "R = diag(",
                           "seed 2009", "10^-5", "10^+5", "second cause", "xi sqrt(Meq)"})
    EXPECT_THAT(text, testing::HasSubstr(said));
}

TEST(PaperReport, DrawsTheFiguresOfTheStudy) {
  // Oracle: figures 2, 3, 5 and 6 of [inverse2009], the law of the damping error, and those that the study
  // shows; no table may have the name of a figure, for both write NAME.csv.
  std::set<std::string> names;
  for (const Figure& figure : figures(test::outcome())) names.insert(figure.name);
  for (const char* name :
       {"figure_2", "figure_3", "figure_5", "figure_6", "damping_law", "step_experiment", "generator_matrix",
        "predicted_differences", "bias_by_process_noise", "error_by_start"})
    EXPECT_TRUE(names.contains(name)) << name;
  for (const auto& part : finding().report)
    if (const auto* table = std::get_if<Table>(&part)) {
      EXPECT_FALSE(names.contains(table->name)) << table->name;
    }
}

}  // namespace
}  // namespace beamid::experiments::paper::report_test
