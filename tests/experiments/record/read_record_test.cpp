// Oracles: the numbers written in the files; the published facts of the measured records.
#include "experiments/record/read_record.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "experiments/record/units.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::read_record_test {
namespace {

/// Time in column 1 [s], acceleration in column 2 [m/s2].
RecordFormat two_columns() {
  RecordFormat format;
  format.time = ColumnDescription{Quantity::acceleration, "", 1, 1.0};
  format.channels = {{Quantity::acceleration, "", 2, 1.0}};
  return format;
}

Record read_text_record(const std::string& content, const RecordFormat& format = two_columns()) {
  const TemporaryFile file("record.txt", content);
  return read_record(file.path(), format);
}

void expect_three_samples(const Record& record) {
  ASSERT_EQ(record.size(), 3);
  EXPECT_EQ(record.time, Eigen::Vector3d(0, 0.5, 1));
  ASSERT_EQ(record.channels.size(), 1u);
  EXPECT_EQ(record.channels[0].quantity, Quantity::acceleration);
  EXPECT_EQ(record.samples, Eigen::RowVector3d(1, -2e-3, 3));
}

TEST(ReadRecord, FindsTheSeparator) {
  expect_three_samples(read_text_record("0\t1\n0.5\t-2e-3\n1\t3\n"));
  expect_three_samples(read_text_record("0;1\n0.5; -2E-3\n1;+3\n"));
  expect_three_samples(read_text_record("0,1\n0.5 , -0.002,\n1,3"));
  expect_three_samples(read_text_record("  0   1 \n 0.5\t\t-.2e-2\n1 3.\n"));
  expect_three_samples(read_text_record("0 \t1 \n0.5 \t-2e-3\n1 \t3\n"));
}

TEST(ReadRecord, TakesTheSeparatorItIsGiven) {
  RecordFormat format = two_columns();
  format.separator = ' ';
  expect_three_samples(read_text_record("0 \t 1 \n0.5 \t-2e-3\n1 \t3\n", format));
  format.separator = ';';
  format.channels[0].number = 3;
  expect_three_samples(
      read_text_record("0;1,5;1\n0.5;1,5;-2e-3\n1;1,5;3\n", format));  // a column not asked for
}

TEST(ReadRecord, AcceptsEveryLineEndBlankLinesCommentsAndAByteOrderMark) {
  expect_three_samples(read_text_record("\r\n0,1\r\n\r\n0.5,-2e-3\r\n1,3\r\n  \r\n"));
  expect_three_samples(read_text_record("0,1\r0.5,-2e-3\r1,3\r"));
  expect_three_samples(read_text_record("# first\n0,1\n% second\n0.5,-2e-3\n  # third, 1, 2\n1,3\n"));
  expect_three_samples(
      read_text_record("\xEF\xBB\xBF"
                       "0,1\n0.5,-2e-3\n1,3\n"));
}

TEST(ReadRecord, FindsColumnsByTheHeadersNames) {
  RecordFormat format = two_columns();
  format.time = ColumnDescription{Quantity::acceleration, "t", 0, 1e-3};
  format.channels[0] = {Quantity::acceleration, "acc tip", 0, 1.0};
  expect_three_samples(read_text_record("\"acc tip\";t;x\n1;0;9\n-2e-3;500;9\n3;1000;9\n", format));
  expect_three_samples(
      read_text_record("# acc tip;t;x\n1;0;9\n-2e-3;500;9\n3;1000;9\n", format));  // numpy's savetxt
  format.header_lines = 4;
  const Record record =
      read_text_record("analyser 7\n1;2;3\nacc tip;t;x\n\n1;0;9\n-2e-3;500;9\n3;1000;9\n", format);
  expect_three_samples(record);
  EXPECT_EQ(record.channels[0].name, "acc tip");
}

// A record of `beamid simulate` has the displacement first; a file made for another says acceleration there.
TEST(ReadRecord, WarnsWhereAColumnIsStatedOtherwiseThanItIsNamed) {
  RecordFormat format = two_columns();
  format.time = ColumnDescription{Quantity::acceleration, "time_s", 0, 1.0};
  const auto warnings = [&](const ColumnDescription& stated) {
    format.channels = {stated};
    return texts(read_text_record("time_s,displacement_tip_m,acceleration_g\n0,1,2\n1,1,2\n2,1,2\n", format)
                     .objections);
  };
  EXPECT_THAT(
      warnings({Quantity::acceleration, "", 2, 1.0}),
      testing::Contains(testing::HasSubstr("named 'displacement_tip_m' and stated as acceleration, which "
                                           "is another quantity")));
  EXPECT_THAT(warnings({Quantity::acceleration, "", 3, 1.0}),
              testing::Contains(testing::HasSubstr("in another unit, 0.101972 times that of its name")));
  EXPECT_THAT(warnings({Quantity::base_acceleration, "", 3, 9.80665}), testing::IsEmpty());
}

TEST(ReadRecord, NeedsNoConfigurationWhenTheHeaderCarriesUnits) {
  const Record record = read_text_record(
      "time_ms,acceleration_g,displacement_root_mm,force_kn\n0,1,2,3\n500,1,2,3\n1000,1,2,3\n", {});
  EXPECT_EQ(record.time, Eigen::Vector3d(0, 0.5, 1));
  ASSERT_EQ(record.channels.size(), 3u);
  EXPECT_EQ(record.channels[0].name, "acceleration");
  EXPECT_EQ(record.channels[1].name, "root");
  EXPECT_EQ(record.channels[1].quantity, Quantity::displacement);
  EXPECT_EQ(record.channels[2].quantity, Quantity::force);
  EXPECT_EQ(record.samples.col(0), Eigen::Vector3d(9.80665, 2e-3, 3000));
}

TEST(ReadRecord, CountsTimeFromTheFirstPrintedOneAtAGivenRate) {
  RecordFormat format = two_columns();
  format.sampling_rate = 3;
  const std::string rounded = "5.0,1\n5.3,1\n5.7,1\n6.0,1\n";
  EXPECT_TRUE(
      read_text_record(rounded, format).time.isApprox(Eigen::Vector4d(5, 16.0 / 3, 17.0 / 3, 6), 1e-15));
  format.time.reset();
  EXPECT_EQ(read_text_record(rounded, format).time[0], 0);  // a column that nothing names as time is none
  EXPECT_EQ(read_text_record("time_s,a\n" + rounded, format).time[0], 5);
}

RecordFormat rate_of(double rate) {
  RecordFormat format = two_columns();
  format.sampling_rate = rate;
  return format;
}

TEST(ReadRecord, TakesTheRoundingOfPrintedTimesForWhatItIs) {
  EXPECT_EQ(read_text_record("0.000,1\n0.003,1\n0.007,1\n0.010,1\n0.013,1\n0.017,1\n").size(), 6);  // 300 Hz
  EXPECT_EQ(read_text_record("99.995,1\n99.998,1\n100.00,1\n100.00,1\n100.01,1\n", rate_of(300)).size(), 5);
}

struct Refused {
  std::string content;
  const char* message;
};

void expect_refused(const RecordFormat& format, std::initializer_list<Refused> cases) {
  for (const Refused& refused : cases) {
    const TemporaryFile file("bad.txt", refused.content);
    EXPECT_EQ(input_error_of(file, [&] { read_record(file.path(), format); }), refused.message)
        << "for the file:\n"
        << refused.content;
  }
}

TEST(ReadRecord, RefusesBadNumbersAtTheirPlaces) {
  expect_refused(
      two_columns(),
      {{"0,1\n1,abc\n", "bad.txt:2:3: column 2 holds 'abc'; expected a number"},
       {"t,a\n0,1\n1, 2 g\n", "bad.txt:3:4: column 2 holds '2 g'; expected a number"},
       {"t;a\n0.5;1\n1;2,5\n", "bad.txt:3:3: column 2 holds '2,5'; expected a number with a decimal point"},
       {"0\t1\n1\tNaN\n",
        "bad.txt:2:3: column 2 holds 'NaN'; expected a finite number within double precision"},
       {"0\t1\n-inf\t2\n",
        "bad.txt:2:1: column 1 holds '-inf'; expected a finite number within double precision"},
       {"0,1\n1,1e999\n",
        "bad.txt:2:3: column 2 holds '1e999'; expected a finite number within double precision"},
       {"0,1,2\n1,,2\n", "bad.txt:2:3: column 2 holds no entry; expected a number"},
       {"0,1\n1,0x10\n", "bad.txt:2:3: column 2 holds '0x10'; expected a number"},
       {"0,1\n1,+-1\n", "bad.txt:2:3: column 2 holds '+-1'; expected a number"},
       {"some,text\nmore,text\n",
        "bad.txt:2:1: a second row without numbers; expected names and units of the columns at most, or "
        "record.header_lines "
        "in the configuration"},
       {"0,1,2\n1,1\n", "bad.txt:2:1: 2 columns; expected 3 as in the first row"},
       {"0 1\n1 1 1\n", "bad.txt:2:1: 3 columns; expected 2 as in the first row"},
       {"0,1\n1,\n", "bad.txt:2:3: column 2 holds no entry; expected a number"}});
}

TEST(ReadRecord, RefusesANumberThatIsTooLargeInTheUnitOfTheRecord) {
  expect_refused({},
                 {{"time_s,acceleration_g\n0,1\n1,1e308\n2,1\n",
                   "bad.txt:3:3: column 2 holds '1e308'; expected a finite number within double precision"}});
}

TEST(ReadRecord, RefusesFilesWithoutRows) {
  RecordFormat headed = two_columns();
  headed.header_lines = 9;
  expect_refused(
      two_columns(),
      {{"", "bad.txt: an empty file; expected a record of numbers in columns"},
       {"\n\r\n  \n", "bad.txt: no row of numbers; expected rows of numbers in columns"},
       {"# only\n% comments\n", "bad.txt: no row of numbers; expected rows of numbers in columns"},
       {"t,a\n", "bad.txt: no row of numbers; expected rows of numbers in columns"},
       {"0,1\n", "bad.txt:1:1: one row of numbers; expected at least two"},
       {std::string("0,1\n1,\0\n", 8),
        "bad.txt:2:3: a binary byte (0); expected a record of numbers in columns in ASCII or UTF-8"}});
  expect_refused(headed,
                 {{"0,1\n1,1\n",
                   "bad.txt: no row of numbers after 9 header lines; expected rows of numbers in columns"}});
}

TEST(ReadRecord, RefusesWhatIsNoFile) {
  const TemporaryFile file("here.txt", "x");
  const auto folder = file.path().parent_path();
  EXPECT_EQ(input_error_of(file, [&] { read_record(folder / "missing.txt", {}); }),
            "missing.txt: no such file; expected a record of numbers in columns");
  EXPECT_EQ(input_error_of(file, [&] { read_record(folder / "", {}); }),
            ": a directory; expected a record of numbers in columns");
}

TEST(ReadRecord, RefusesColumnsThatAreNotThere) {
  RecordFormat by_name = two_columns(), by_number = two_columns();
  by_name.channels[0] = {Quantity::acceleration, "acc", 0, 1.0};
  by_number.channels[0].number = 3;
  expect_refused(by_number,
                 {{"\n0,1\n1,1\n", "bad.txt:2:1: 2 columns; expected at least 3, the column requested"}});
  expect_refused(
      by_name,
      {{"0,1\n1,1\n", "bad.txt: no header; expected one that names the column 'acc'"},
       {"\nt,ac\n0,1\n1,1\n", "bad.txt:2:1: no column 'acc'; did you mean 'ac'?; the header names: t, ac"},
       {"time,velocity\n0,1\n1,1\n", "bad.txt:1:1: no column 'acc'; the header names: time, velocity"},
       {"t,acc,acc\n0,1,2\n1,1,2\n", "bad.txt:1:1: several columns 'acc'; expected one, or its number"},
       {"t,a,acc\n0,1\n1,1\n", "bad.txt:2:1: 2 columns; expected 3 for the column 'acc'"}});
}

#define KNOWN                                                                                             \
  "time_s, time_ms, time_us, displacement_m, displacement_mm, displacement_um, velocity_m_per_s, "        \
  "velocity_mm_per_s, acceleration_m_per_s2, acceleration_mm_per_s2, acceleration_g, force_n, force_kn, " \
  "strain_m_per_m, strain_um_per_m, base_acceleration_m_per_s2, base_acceleration_mm_per_s2, "            \
  "base_acceleration_g, support_acceleration_m_per_s2, support_acceleration_mm_per_s2, "                  \
  "support_acceleration_g, angular_acceleration_rad_per_s2, angular_acceleration_mrad_per_s2"

TEST(ReadRecord, RefusesHeadersThatDoNotTellTheUnits) {
  expect_refused(
      {}, {{"time_s,acceleration_ft_per_s2\n0,1\n1,1\n",
            "bad.txt:1: unknown column 'acceleration_ft_per_s2'; expected names with units (" KNOWN
            "), or --column N --quantity acceleration --unit g, or record.channels in the configuration"},
           {"time_s\n0\n1\n", "bad.txt:1: no column but time; expected a measured quantity"},
           {"time_s,time_ms,force_n\n0,1,2\n1,1,2\n",
            "bad.txt:1: columns 1 and 2 are times; expected one of them, and what it is of: --time 1:s "
            "--column N, or --time 2:s --column N"},
           {"force_n\n0\n1\n",
            "bad.txt: no column of time; expected the sampling rate, --rate HZ, or the column, --time "
            "COLUMN:UNIT (record.sampling_rate_hz, record.time in the configuration)"}});
}

// One decay at 400 Hz, 4 m/s2 at first, as people write it.
TEST(ReadRecord, AsksForTheRateWhereAColumnCountsSamples) {
#define RATE "; expected the sampling rate: --rate HZ, or record.sampling_rate_hz in the configuration"
  expect_refused({}, {{"Sample,Acc X [g]\n0,1\n1,1\n2,1\n", "bad.txt: Column 1 counts samples" RATE},
                      {"0,1\n1,1\n", "bad.txt: Column 1 counts samples" RATE},
                      {"1\n2\n1\n", "bad.txt: One column, and no times" RATE}});
#undef RATE
}

TEST(ReadRecord, RefusesIrregularTimes) {
  expect_refused(
      two_columns(),
      {{"0,1\n0.1,1\n0.1,1\n", "bad.txt:3:1: time 0.1 after 0.1; expected increasing times"},
       {"0,1\n0.1,1\n0.05,1\n", "bad.txt:3:1: time 0.05 after 0.1; expected increasing times"},
       {"0.000,1\n0.100,1\n0.200,1\n0.400,1\n0.500,1\n",
        "bad.txt:4:1: time 0.4 after 0.2: 1 row is missing between them, at the median interval 0.1"
        "; expected all rows, or [record] with stamps = \"as_they_are\" (usual) and malformed = \"missing\", "
        "which takes their samples for not read, and missing_input = \"leave_out\" where an input was "
        "measured"},
       {"# a gap of one sample in rounded times\n0.0006,1\n0.0012,1\n0.0018,1\n0.0030,1\n0.0036,1\n",
        "bad.txt:5:1: time 0.003 after 0.0018: 1 row is missing between them, at the median interval 0.0006"
        "; expected all rows, or [record] with stamps = \"as_they_are\" (usual) and malformed = \"missing\", "
        "which takes their samples for not read, and missing_input = \"leave_out\" where an input was "
        "measured"}});
  RecordFormat rate = two_columns();
  rate.sampling_rate = 10;
  expect_refused(
      rate,
      {{"0,1\n0.103,1\n0.206,1\n0.369,1\n",
        "bad.txt:4:1: time 0.369 s of sample 4, which 10 Hz, as stated, puts at 0.3 s: the stamps run at "
        "8.1300813 Hz in the mean; expected them within half an interval. Without a stated rate the stamps "
        "are taken as they are"}});
}

std::string many_rows(int rows) {
  std::string text;
  for (int i = 0; i < rows; ++i) text += std::to_string(i) + ",1\n";
  return text;
}

TEST(ReadRecord, CutsTheWindowAndBlamesItsPlace) {
  RecordFormat format = two_columns();
  format.window = {10, 29};
  EXPECT_EQ(read_text_record(many_rows(50), format).size(), 20);
  EXPECT_EQ(read_text_record(many_rows(50), format).time[0], 10);
  expect_refused(
      format, {{many_rows(25),
                "bad.txt: window 10 to 29 s; expected at least 16 samples inside the record, which runs from "
                "0 to 24 s"}});
  format.window_place = {"study.toml", 7, 12};
  expect_refused(
      format, {{many_rows(25),
                "study.toml:7:12: window 10 to 29 s; expected at least 16 samples inside the record, which "
                "runs from 0 to 24 s"}});
}

/// The records' documented layout: first line blank, then t [s], a dead channel, acceleration [g], force [N];
/// 4108 samples at 51200 / 31 Hz. First and last values are read off the files.
TEST(ReadRecord, ReadsTheFiveMeasuredRecords) {
  const std::filesystem::path folder = BEAMID_SOURCE_DIR "/../shared/data/unb-tip-mass";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no measured records beside the project";
  RecordFormat format;
  format.time = ColumnDescription{Quantity::acceleration, "", 1, 1.0};
  format.channels = {{Quantity::acceleration, "", 3, 9.80665}, {Quantity::force, "", 4, 1.0}};
  const struct {
    const char* name;
    double first, second, first_force, last;
  } records[] = {{"massa1_test1-1", -0.003027, 0.006692, -0.190312, -0.104246},
                 {"massa2_test1-2", -0.001632, 0.003527, -0.090897, -0.050402},
                 {"massa3_test2-3", -0.005331, 0.013986, -0.143449, 0.011997},
                 {"massa4_test1-4", -0.011715, 0.004631, 0.005808, -0.002196},
                 {"massa4_test2-4", 0.015762, -0.016292, -0.009361, -0.001711}};
  for (const auto& expected : records) {
    SCOPED_TRACE(expected.name);
    const auto file = folder / (std::string(expected.name) + ".txt");
    format.window.reset();
    format.sampling_rate.reset();
    const Record printed = read_record(file, format);
    ASSERT_EQ(printed.size(), 4108);
    EXPECT_EQ(printed.time[4107], 2.486660);
    EXPECT_DOUBLE_EQ(printed.samples(0, 0), expected.first * 9.80665);
    EXPECT_DOUBLE_EQ(printed.samples(0, 1), expected.second * 9.80665);
    EXPECT_DOUBLE_EQ(printed.samples(1, 0), expected.first_force);
    EXPECT_DOUBLE_EQ(printed.samples(0, 4107), expected.last * 9.80665);
    format.sampling_rate = 51200.0 / 31;
    const Record exact = read_record(file, format);
    EXPECT_EQ(exact.samples, printed.samples);
    EXPECT_LT((exact.time - printed.time).cwiseAbs().maxCoeff(), 0.51e-6);  // half a printed digit
    format.window = {0.808, 1.608};
    const Record window = read_record(file, format);
    EXPECT_NEAR(static_cast<double>(window.size()), 0.8 * 51200 / 31, 1.5);
    EXPECT_NEAR(window.time[0], 0.808, 0.31e-3);
  }
}

#undef KNOWN

}  // namespace
}  // namespace beamid::experiments::read_record_test
