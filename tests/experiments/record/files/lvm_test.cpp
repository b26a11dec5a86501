// LabVIEW measurements: what is read, what is refused.
// Oracles: the numbers written into the files, by hand from the formats' descriptions or by the libraries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/record/read_record.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/files/damaged_file.hpp"
#include "tests/experiments/record/files/written_record.hpp"

namespace beamid::experiments::lvm_test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

/// @param x_columns No, One or Multi.
std::string lvm(const std::string& x_columns, char decimal = '.', bool two_segments = false) {
  std::string text = "LabVIEW Measurement\t\r\nWriter_Version\t2\r\nReader_Version\t2\r\nSeparator\tTab\r\n";
  text += std::string("Decimal_Separator\t") + decimal + "\r\nMulti_Headings\tYes\r\nX_Columns\t" +
          x_columns + "\r\nTime_Pref\tRelative\r\n***End_of_Header***\t\r\n\t\r\n";
  const auto segment = [&](int from, int to) {
    const std::string count = std::to_string(to - from), start = printed("%.6f", 0.01 * from);
    std::string rows = "Channels\t2\t\t\r\nSamples\t" + count + "\t" + count +
                       "\t\r\nY_Unit_Label\tg\tN\t\r\nX_Dimension\tTime\tTime\t\r\nX0\t" + start + "\t" +
                       start + "\t\r\nDelta_X\t0,010000\t0,010000\t\r\n***End_of_Header***\t\t\t\r\n";
    rows += x_columns == "Multi" ? "X_Value\tTip\tX_Value\tHammer\tComment\r\n"
                                 : "X_Value\tTip\tHammer\tComment\r\n";
    for (int k = from; k < to; ++k) {
      const std::string x = x_columns == "No" ? "" : printed("%.6f", 0.01 * k);
      rows += x + "\t" + printed("%.9f", first_signal(k)) + (x_columns == "Multi" ? "\t" + x : "") + "\t" +
              printed("%.6E", second_signal(k)) + (k == from ? "\tfirst" : "") + "\r\n";
    }
    for (char& letter : rows) letter = letter == ',' || letter == '.' ? decimal : letter;
    return rows;
  };
  return text + (two_segments ? segment(0, 25) + "\r\n" + segment(25, written_samples)
                              : segment(0, written_samples));
}

TEST(LvmReader, ReadsEveryArrangementOfItsColumns) {
  for (const char* x_columns : {"No", "One", "Multi"})
    for (const char decimal : {'.', ','}) {
      SCOPED_TRACE(std::string(x_columns) + decimal);
      const TemporaryFile file("test.lvm", lvm(x_columns, decimal));
      const Record record = read_record(file.path());
      expect_both(record, 1e-5);
      EXPECT_EQ(record.channels[1].name, "Hammer");
    }
}

TEST(LvmReader, JoinsSegmentsAndSaysSo) {
  for (const char* x_columns : {"No", "One", "Multi"}) {
    const TemporaryFile file("test.lvm", lvm(x_columns, '.', true));
    const Record record = read_record(file.path());
    expect_both(record, 1e-5);
    EXPECT_THAT(record.remarks, ElementsAre("2 segments are joined."));
    EXPECT_THAT(texts(record.objections), testing::IsEmpty());
  }
}

struct LvmHeader {
  double start, interval;
  std::string unit = "g";
  int stated = 20;
  bool x_value = false;
};

/// Segments of 20 rows each.
std::string lvm_segments(const std::vector<LvmHeader>& headers) {
  std::string text = "LabVIEW Measurement\nSeparator\tTab\n***End_of_Header***\n";
  for (const LvmHeader& header : headers) {
    text += "Channels\t1\nSamples\t" + std::to_string(header.stated) + "\nY_Unit_Label\t" + header.unit +
            "\nX_Dimension\tTime\nX0\t" + printed("%.6f", header.start) + "\nDelta_X\t" +
            printed("%.6f", header.interval) + "\n***End_of_Header***\n" +
            (header.x_value ? "X_Value\t" : "") + "Tip\n";
    for (int k = 0; k < 20; ++k)
      text += (header.x_value ? printed("%.6f", header.start + k * header.interval) + "\t" : std::string()) +
              printed("%.6f", first_signal(k)) + "\n";
  }
  return text;
}

std::string lvm_error(const std::vector<LvmHeader>& headers) {
  const TemporaryFile file("parts.lvm", lvm_segments(headers));
  return input_error_of(file, [&] { read_record(file.path()); });
}

// Each of these was read as one record at the last segment's interval, start and unit.
TEST(LvmReader, TakesInstantsAndUnitsFromEachSegmentsOwnHeader) {
  EXPECT_EQ(lvm_error({{0.0, 0.004}, {0.08, 0.004}}), "no error");
  EXPECT_EQ(lvm_error({{0.0, 0.004}, {0.08, 0.001}}),
            "parts.lvm:41:1: time 0.081 after 0.08, an interval of 0.001; expected the median interval 0.004 "
            "within "
            "5 %");
  EXPECT_EQ(lvm_error({{0.0, 0.004}, {100.0, 0.004}}),
            "parts.lvm:40:1: time 100 after 0.076, an interval of 99.924; expected the median interval 0.004 "
            "within "
            "5 %");
  EXPECT_EQ(lvm_error({{0.0, 0.004}, {0.0, 0.004}}),
            "parts.lvm:38:1: a segment that begins at 0 s, where the one before runs to 0.076 s; expected "
            "segments in "
            "succession");
  EXPECT_EQ(lvm_error({{0.0, 0.004, "mm"}, {0.08, 0.004, "g"}}),
            "parts.lvm:38:1: Y_Unit_Label 'g' after 'mm' in the segment before; expected the same");
  EXPECT_EQ(lvm_error({{0.0, 0.004, "g", 20, true}, {0.08, 0.004}}),
            "parts.lvm:40:1: a segment without X_Value; expected all of them alike");
}

// Oracle: the headers. As they are, the instants are those of both segments.
TEST(LvmReader, MakesStampsWhereSegmentsDoNotFollowEachOther) {
  const TemporaryFile file("parts.lvm", lvm_segments({{1.0, 0.004}, {3.0, 0.001}}));
  RecordFormat format;
  format.irregular = true;
  const Record record = read_record(file.path(), format);
  ASSERT_EQ(record.size(), 40);
  for (int k = 0; k < 20; ++k) {
    EXPECT_DOUBLE_EQ(record.time[k], 1.0 + 0.004 * k);
    EXPECT_DOUBLE_EQ(record.time[20 + k], 3.0 + 0.001 * k);
  }
}

TEST(LvmReader, WarnsOfATornSegment) {
  const TemporaryFile file("torn.lvm", lvm_segments({{0.0, 0.004, "g", 900}}));
  EXPECT_THAT(texts(read_record(file.path()).objections),
              ElementsAre("Segment 1 has 20 rows where its header states 900 samples: the others are lost."));
}

TEST(LvmReader, RefusesBadFieldsAtTheirPlaces) {
  std::string text = lvm("One");
  text.replace(text.find("0.010000\t0.8"), 12, "0.010000\tabc");
  const TemporaryFile file("bad.lvm", text);
  EXPECT_THAT(input_error_of(file, [&] { read_record(file.path()); }),
              testing::StartsWith("bad.lvm:20:10: column 2 holds 'abc"));
  const TemporaryFile open("open.lvm", "LabVIEW Measurement\nSeparator\tTab\n");
  EXPECT_EQ(input_error_of(open, [&] { read_record(open.path()); }),
            "open.lvm:2:1: the file ends in its header; expected ***End_of_Header***");
}

// A channel without a label is what its name says of it, and cells that a second X column has in the header
// hold nothing.
TEST(LvmReader, ReadsChannelsWithoutUnitsAndEmptyCellsOfAHeader) {
  std::string unlabelled = lvm("Multi", ',');
  const std::size_t label = unlabelled.find("Y_Unit_Label");
  unlabelled.erase(label, unlabelled.find("X_Dimension") - label);
  for (const char* const row : {"X0\t0,000000\t", "Delta_X\t0,010000\t"})
    unlabelled.replace(unlabelled.find(row), std::string(row).size(), std::string(row) + "\t");
  const TemporaryFile file("unlabelled.lvm", unlabelled);
  const Record record = read_record(file.path());
  ASSERT_EQ(record.channels.size(), 2U);
  EXPECT_EQ(record.channels[0].quantity, Quantity::acceleration);
  EXPECT_EQ(record.channels[1].quantity, Quantity::force);  // "Hammer"
  EXPECT_NEAR(record.interval(), 0.01, 1e-9);
  EXPECT_NEAR(record.samples(0, 3), first_signal(3), 1e-8);
}

TEST(LvmReader, LetsAStatedRateReplaceARoundedInterval) {
  const TemporaryFile file("test.lvm", lvm("No"));
  RecordFormat format;
  format.sampling_rate = 99.5;
  EXPECT_DOUBLE_EQ(read_record(file.path(), format).interval(), 1 / 99.5);
  format.sampling_rate = 90;
  EXPECT_THAT(input_error_of(file, [&] { read_record(file.path(), format); }),
              HasSubstr("expected 0.0111111 s within 2 %"));
}

TEST(LvmReader, ReadsOrRefusesDamagedFiles) {
  expect_read_or_refused("fuzz.lvm", lvm("Multi", ',', true), {}, 1, 300);
  expect_read_or_refused("fuzz.lvm", lvm("No"), {}, 2, 300);
}

}  // namespace
}  // namespace beamid::experiments::lvm_test
