// Delimited text, beyond what read_record_test.cpp holds.
// Oracles: the numbers written into the files, by hand from the formats' descriptions or by the libraries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/record/read_record.hpp"
#include "experiments/record/record_table.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/files/damaged_file.hpp"
#include "tests/experiments/record/files/written_record.hpp"

namespace beamid::experiments::delimited_text_test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

TEST(DelimitedTextReader, TakesADecimalCommaWhereRowsShowIt) {
  for (const char* text :
       {"t;a\n0;1,5\n0,5;-2\n1;3,25\n", "0 1,5\n0,5 -2\n1 3,25\n", "0\t1,5\n0,5\t-2\n1\t3,25\n"}) {
    RecordFormat format;
    format.time = ColumnDescription{Quantity::acceleration, "", 1, 1.0};
    format.channels = {{Quantity::acceleration, "", 2, 1.0}};
    const TemporaryFile file("comma.txt", text);
    const Record record = read_record(file.path(), format);
    EXPECT_EQ(record.samples, Eigen::RowVector3d(1.5, -2, 3.25)) << text;
    EXPECT_EQ(record.time, Eigen::Vector3d(0, 0.5, 1)) << text;
  }
}

TEST(DelimitedTextReader, CountsAndLocatesTheLinesItIsToldToSkip) {
  const TemporaryFile file(
      "bad.txt",
      "C:\\data\\run 5.txt\nRate - 10\na\tb\tt\ng\tg\ts\n0.0 0.0\t\t1\n1\t2\t0.00\n2\t3\t0.10\n3\tx\t0.20\n"
      "4\t5\t0.30\n5\t6\n6\t7\t0.40\n");
  EXPECT_NE(input_error_of(file, [&] { read_record(file.path()); }), "no error");
  RecordFormat format;
  format.malformed = MalformedRows::skip, format.irregular = true;
  const Record record = read_record(file.path(), format);
  EXPECT_EQ(record.time, (Eigen::Vector4d(0, 0.1, 0.3, 0.4)));
  EXPECT_EQ(record.channel_names(), (std::vector<std::string>{"a", "b"}));
  EXPECT_THAT(
      record.remarks,
      ElementsAre("3 lines are omitted, as each is not a row of numbers like the others: lines 5, 8, 10."));
  format.irregular = false;
  EXPECT_THAT(input_error_of(file, [&] { read_record(file.path(), format); }),
              HasSubstr("bad.txt:9:5: time 0.3 after 0.1"));
}

// Loggers of several rates leave cells empty, the last of a row among them.
TEST(DelimitedTextReader, TakesEmptyCellsForMissingWhereToldTo) {
  const TemporaryFile file("rates.csv",
                           "time_s,acceleration_m_per_s2,force_n\n0,1,\n0.1,,2\n0.2,3,nan\n0.3, NA ,5\n");
  EXPECT_EQ(input_error_of(file, [&] { read_record(file.path()); }),
            "rates.csv:2:5: column 3 holds no entry; expected a number");
  RecordFormat format;
  format.malformed = MalformedRows::as_missing;
  const Eigen::MatrixXd samples = read_record(file.path(), format).samples;
  const auto is_read = samples.array().isFinite();
  EXPECT_EQ(is_read.count(), 4);
  EXPECT_EQ(is_read.select(samples, 0.0), (Eigen::MatrixXd(2, 4) << 1, 0, 3, 0, 0, 2, 0, 5).finished());
  const TemporaryFile text("text.csv", "time_s,force_n\n0,1\n0.1,broken\n0.2,3\n");
  EXPECT_EQ(input_error_of(text, [&] { read_record(text.path(), format); }),
            "text.csv:3:5: column 2 holds 'broken'; expected a number");
  const TemporaryFile stamp("stamp.csv", "time_s,force_n\n0,1\n,2\n0.2,3\n");
  EXPECT_EQ(input_error_of(stamp, [&] { read_record(stamp.path(), format); }),
            "stamp.csv:3:1: column 1 holds no entry; expected a number");
}

TEST(DelimitedTextReader, ReadsOrRefusesDamagedFiles) {
  std::string text = "time_s,acceleration_g\n";
  for (int k = 0; k < written_samples; ++k)
    text += printed("%.2f", 0.01 * k) + "," + printed("%.6f", first_signal(k)) + "\n";
  RecordFormat tolerant;
  tolerant.malformed = MalformedRows::skip;
  expect_read_or_refused("fuzz.csv", text, {}, 5, 300);
  expect_read_or_refused("fuzz.csv", text, tolerant, 6, 300);
}

TEST(ReadRecord, TakesUnequalIntervalsOnlyWhenToldAndRepeatedStampsNever) {
  RecordFormat format;
  format.irregular = true;
  const TemporaryFile uneven("uneven.csv", "time_s,force_n\n0,1\n0.1,2\n0.35,3\n");
  EXPECT_EQ(read_record(uneven.path(), format).time, Eigen::Vector3d(0, 0.1, 0.35));
  const TemporaryFile twice("twice.csv", "time_s,force_n\n0,1\n0.1,2\n0.1,3\n");
  EXPECT_EQ(input_error_of(twice, [&] { read_record(twice.path(), format); }),
            "twice.csv:4:1: time 0.1 after 0.1; expected increasing times");
}

// A header in Latin-1, as most German loggers write it, made figures that no browser draws.
TEST(ReadRecord, TurnsNamesIntoUtf8WithoutControlCharacters) {
  const TemporaryFile file("latin.csv", "Zeit [s];Beschleunigung [m/s\xb2]\x1b[2J\n0;1\n0.1;2\n0.2;3\n");
  const RecordTable table = read_table(file.path(), {});
  EXPECT_THAT(table.names, ElementsAre("Zeit [s]", "Beschleunigung [m/s²][2J"));
  RecordFormat format;
  format.time = ColumnDescription{Quantity::acceleration, "Zeit [s]", 0, 1.0};
  format.channels = {{Quantity::acceleration, "Beschleunigung [m/s²][2J", 0, 1.0}};
  EXPECT_EQ(read_record(file.path(), format).samples, Eigen::RowVector3d(1, 2, 3));
}

TEST(ReadRecord, RefusesAUnitThatContradictsTheName) {
  const TemporaryFile file("units.txt", "time_s\tacceleration_g\ns\tm/s2\n0\t1\n0.1\t2\n0.2\t3\n");
  RecordFormat format;
  format.malformed = MalformedRows::skip;
  EXPECT_EQ(input_error_of(file, [&] { read_record(file.path(), format); }),
            "units.txt:1: 'acceleration_g' has the unit 'm/s2'; expected the one of its name");
}

}  // namespace
}  // namespace beamid::experiments::delimited_text_test
