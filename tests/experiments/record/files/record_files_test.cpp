// Every kind of record file: what is read, what is refused, and that damaged files are refused too.
// Oracles: the numbers written into the files, by hand from the formats' descriptions or by the libraries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <matio.h>

#include <cmath>
#include <cstring>
#include <random>

#include "experiments/record/read_record.hpp"
#include "experiments/record/record_reader.hpp"
#include "experiments/text/text_file.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::record_files_test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

constexpr int samples = 40;

double first_signal(int k) {
  return std::sin(0.7 * k) + 0.25;
}
double second_signal(int k) {
  return 3.0 * std::cos(0.2 * k);
}

/// Acceleration [g] and force [N], forty samples at 100 Hz.
void expect_both(const Record& record, double tolerance) {
  ASSERT_EQ(record.size(), samples);
  ASSERT_EQ(record.channels.size(), 2u);
  EXPECT_EQ(record.channels[0].quantity, Quantity::acceleration);
  EXPECT_EQ(record.channels[1].quantity, Quantity::force);
  for (int k = 0; k < samples; ++k) {
    EXPECT_NEAR(record.time[k], 0.01 * k, 1e-6);
    EXPECT_NEAR(record.samples(0, k), 9.80665 * first_signal(k), 10 * tolerance);
    EXPECT_NEAR(record.samples(1, k), second_signal(k), tolerance);
  }
}

std::string printed(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), format, value);
  return buffer;
}

// ---- LabVIEW

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
  return text + (two_segments ? segment(0, 25) + "\r\n" + segment(25, samples) : segment(0, samples));
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
    EXPECT_THAT(record.warnings, testing::IsEmpty());
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
  EXPECT_THAT(read_record(file.path()).warnings,
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

TEST(LvmReader, LetsAStatedRateReplaceARoundedInterval) {
  const TemporaryFile file("test.lvm", lvm("No"));
  RecordFormat format;
  format.sampling_rate = 99.5;
  EXPECT_DOUBLE_EQ(read_record(file.path(), format).interval(), 1 / 99.5);
  format.sampling_rate = 90;
  EXPECT_THAT(input_error_of(file, [&] { read_record(file.path(), format); }),
              HasSubstr("expected 0.0111111 s within 2 %"));
}

// ---- Universal File

std::string records_6_to_11(int node, int ordinate, int points, bool even, const char* unit,
                            const char* abscissa_unit = "s", double step = 0.01) {
  char line[200];
  std::string text;
  std::snprintf(line, sizeof(line), "%5d%10d%5d%10d %10s%10d%4d %10s%10d%4d\n", 1, 0, 0, 0, "NONE", node, 3,
                "NONE", 0, 0);
  text += line;
  std::snprintf(line, sizeof(line), "%10d%10d%10d%13.5e%13.5e%13.5e\n", ordinate, points, even ? 1 : 0, 0.0,
                even ? step : 0.0, 0.0);
  text += line;
  std::snprintf(line, sizeof(line), "%10d%5d%5d%5d %-20s %-20s\n", 17, 0, 0, 0, "Time", abscissa_unit);
  text += line;
  std::snprintf(line, sizeof(line), "%10d%5d%5d%5d %-20s %-20s\n", 12, 0, 0, 0, "NONE", unit);
  text += line;
  for (int k = 0; k < 2; ++k) text += "         0    0    0    0 NONE                 NONE                \n";
  return text;
}

std::string identification() {
  return "Hammer test\nNONE\n21-NOV-26 10:00:00\nNONE\nNONE\n";
}

std::string ascii_58(int node, int ordinate, bool even, const char* unit, double (*signal)(int)) {
  std::string text =
      "    -1\n    58\n" + identification() + records_6_to_11(node, ordinate, samples, even, unit);
  int fields = 0;
  const int in_row = ordinate == 2 ? 6 : 4;
  const auto put = [&](const std::string& number) {
    text += number;
    if (++fields % in_row == 0) text += "\n";
  };
  for (int k = 0; k < samples; ++k) {
    if (!even) put(printed("%13.5E", 0.01 * k));
    put(printed(ordinate == 2 ? "%13.5E" : "%20.12E", signal(k)));
  }
  return text + (fields % in_row ? "\n" : "") + "    -1\n";
}

/// @param order 1: little endian, 2: big endian.
std::string binary_58(int node, int ordinate, bool even, int order, const char* unit, double (*signal)(int)) {
  std::string data;
  const auto put = [&](double value) {
    char raw[8];
    const std::size_t width = ordinate == 2 ? 4 : 8;
    const auto single = static_cast<float>(value);
    if (ordinate == 2)
      std::memcpy(raw, &single, width);
    else
      std::memcpy(raw, &value, width);
    if (order == 2) std::reverse(raw, raw + width);
    data.append(raw, width);
  };
  for (int k = 0; k < samples; ++k) {
    if (!even) put(0.01 * k);
    put(signal(k));
  }
  char line[200];
  std::snprintf(line, sizeof(line), "    -1\n%6d%c%6d%6d%12d%12d%6d%6d%12d%12d\n", 58, 'b', order, 2, 11,
                static_cast<int>(data.size()), 0, 0, 0, 0);
  return line + identification() + records_6_to_11(node, ordinate, samples, even, unit) + data + "\n    -1\n";
}

TEST(Uff58Reader, ReadsAsciiOfBothPrecisionsAndSpacings) {
  for (const int ordinate : {2, 4})
    for (const bool even : {true, false}) {
      SCOPED_TRACE(testing::Message() << ordinate << " " << even);
      const TemporaryFile file("test.uff", "    -1\n   151\nmodel\nanother dataset\n    -1\n" +
                                               ascii_58(1, ordinate, even, "g", first_signal) +
                                               ascii_58(7, ordinate, even, "N", second_signal));
      const Record record = read_record(file.path());
      expect_both(record, ordinate == 2 ? 1e-5 : 1e-11);
      EXPECT_EQ(record.channels[1].name, "7:+Z");
    }
}

TEST(Uff58Reader, ReadsBinaryOfBothByteOrders) {
  for (const int order : {1, 2})
    for (const int ordinate : {2, 4})
      for (const bool even : {true, false}) {
        SCOPED_TRACE(testing::Message() << order << " " << ordinate << " " << even);
        const TemporaryFile file("test.unv", binary_58(1, ordinate, even, order, "g", first_signal) +
                                                 binary_58(2, ordinate, even, order, "N", second_signal));
        expect_both(read_record(file.path()), ordinate == 2 ? 1e-6 : 1e-13);
      }
}

// Oracle: the same numbers in another unit of time; frequencies were wrong by 1000.
TEST(Uff58Reader, TakesTheUnitOfTheAbscissa) {
  const auto file_of = [](const char* unit, bool even) {
    return "    -1\n    58\n" + identification() + records_6_to_11(1, 2, 3, even, "g", unit, 4.0) +
           (even ? "  1.00000E+00  2.00000E+00  3.00000E+00\n"
                 : "  0.00000E+00  1.00000E+00  4.00000E+00  2.00000E+00  8.00000E+00  3.00000E+00\n") +
           "    -1\n";
  };
  for (const bool even : {true, false}) {
    const TemporaryFile milli("ms.uff", file_of("ms", even)), plain("s.uff", file_of("", even)),
        other("min.uff", file_of("min", even));
    EXPECT_NEAR(read_record(milli.path()).interval(), 0.004, 1e-15);
    EXPECT_NEAR(read_record(plain.path()).interval(), 4.0, 1e-15);
    for (const char* unit : {"s", "SEC", "Seconds", "NONE"}) {
      const TemporaryFile old("old.uff", file_of(unit, even));
      EXPECT_NEAR(read_record(old.path()).interval(), 4.0, 1e-15) << unit;
    }
    EXPECT_EQ(input_error_of(other, [&] { read_record(other.path()); }),
              "min.uff: the abscissa of '1:+Z' is in 'min'; expected times in s, ms, us, or record.time or "
              "record.sampling_rate_hz in the configuration");
    RecordFormat stated;
    stated.sampling_rate = 10.0;
    if (even) {
      EXPECT_NEAR(read_record(other.path(), stated).interval(), 0.1, 1e-15);
    }
  }
}

// 4000 datasets of one name took 57 s: the names (2), (3), ... were sought from the start for each.
TEST(Uff58Reader, NumbersManyDatasetsOfOneName) {
  const std::string one = "    -1\n    58\n" + identification() + records_6_to_11(1, 2, 3, true, "g") +
                          "  1.00000E+00  2.00000E+00  3.00000E+00\n    -1\n";
  std::string all;
  for (int k = 0; k < 4000; ++k) all += one;
  const TemporaryFile file("many.uff", all);
  const RecordTable table = read_table(file.path(), {});
  ASSERT_EQ(table.names.size(), 4000u);
  EXPECT_EQ(table.names[0], "1:+Z");
  EXPECT_EQ(table.names[3999], "1:+Z (4000)");
}

TEST(Uff58Reader, ReadsNumbersThatTouch) {
  std::string text = "    -1\n    58\n" + identification() + records_6_to_11(1, 2, 3, true, "g");
  const TemporaryFile file("test.uff", text + "-1.00000E+000-2.00000E+000-3.00000E+000\n    -1\n");
  EXPECT_EQ(read_record(file.path()).samples, 9.80665 * Eigen::RowVector3d(-1, -2, -3));
}

TEST(Uff58Reader, RefusesWhatItCannotRead) {
  std::string cut = ascii_58(1, 4, true, "g", first_signal);
  const TemporaryFile short_file("cut.uff", cut.substr(0, cut.size() / 2));
  EXPECT_THAT(input_error_of(short_file, [&] { read_record(short_file.path()); }), HasSubstr("expected 40"));
  const TemporaryFile none("none.uff", "    -1\n   151\nmodel\n    -1\n");
  EXPECT_EQ(input_error_of(none, [&] { read_record(none.path()); }),
            "none.uff: no real time response among 0 datasets 58; expected one");
  const TemporaryFile volts("volts.uff", ascii_58(1, 4, true, "V", first_signal));
  EXPECT_EQ(
      input_error_of(volts, [&] { read_record(volts.path()); }),
      "volts.uff: no unit says what is measured: '1:+Z' [V]; expected record.channels in the configuration");
}

// ---- MATLAB and HDF5

void write_variable(mat_t* file, const char* name, std::size_t rows, std::size_t columns,
                    std::vector<double> values) {
  std::size_t size[2] = {rows, columns};
  matvar_t* const variable = Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, values.data(), 0);
  Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE);
  Mat_VarFree(variable);
}

std::vector<double> values_of(double (*signal)(int)) {
  std::vector<double> values(samples);
  for (int k = 0; k < samples; ++k) values[static_cast<std::size_t>(k)] = signal(k);
  return values;
}

/// dt, a row vector acceleration_g, and data.hammer, a column vector in a struct.
void write_mat(const std::filesystem::path& path, mat_ft version) {
  mat_t* const file = Mat_CreateVer(path.c_str(), nullptr, version);
  ASSERT_NE(file, nullptr);
  write_variable(file, "dt", 1, 1, {0.01});
  write_variable(file, "acceleration_g", 1, samples, values_of(first_signal));
  std::vector<double> both = values_of(second_signal), copy = both;
  both.insert(both.end(), copy.begin(), copy.end());
  std::size_t one[2] = {1, 1}, size[2] = {samples, 2};
  const char* fields[] = {"hammer"};
  matvar_t* const data = Mat_VarCreateStruct("data", 2, one, fields, 1);
  Mat_VarSetStructFieldByName(data, "hammer", 0,
                              Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, both.data(), 0));
  Mat_VarWrite(file, data, MAT_COMPRESSION_NONE);
  Mat_VarFree(data);
  Mat_Close(file);
}

RecordFormat mat_channels() {
  RecordFormat format;
  format.channels = {{Quantity::acceleration, "acceleration_g", 0, 9.80665},
                     {Quantity::force, "data.hammer(:,2)", 0, 1}};
  return format;
}

TEST(MatReader, ReadsLevelFiveAndSevenPointThree) {
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    const TemporaryFile file("test.mat", "");
    write_mat(file.path(), version);
    expect_both(read_record(file.path(), mat_channels()), 1e-13);
    RecordFormat missing = mat_channels();
    missing.channels[0].name = "acc";
    EXPECT_THAT(
        input_error_of(file, [&] { read_record(file.path(), missing); }),
        HasSubstr("no column 'acc'; the file holds: acceleration_g, data.hammer(:,1), data.hammer(:,2)"));
  }
}

matvar_t* vector_of(double (*signal)(int), bool as_row) {
  std::size_t size[2] = {as_row ? 1u : samples, as_row ? samples : 1u};
  std::vector<double> values = values_of(signal);
  return Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, values.data(), 0);
}

// Oracle: what was written. Only the first element of a struct array was read, and nothing below one level.
TEST(MatReader, ReadsStructsOfAnyDepthTheirArraysAndCells) {
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    const TemporaryFile made("deep.mat", "");
    mat_t* const file = Mat_CreateVer(made.path().c_str(), nullptr, version);
    ASSERT_NE(file, nullptr);
    write_variable(file, "Fs", 1, 1, {100.0});
    std::size_t one[2] = {1, 1}, two[2] = {1, 2};
    const char* outer[] = {"tip"};
    const char* inner[] = {"x"};
    matvar_t* const runs = Mat_VarCreateStruct("run", 2, two, outer, 1);
    for (std::size_t k = 0; k < 2; ++k) {
      matvar_t* const tip = Mat_VarCreateStruct(nullptr, 2, one, inner, 1);
      Mat_VarSetStructFieldByName(tip, "x", 0, vector_of(k == 0 ? first_signal : second_signal, k == 0));
      Mat_VarSetStructFieldByName(runs, "tip", k, tip);
    }
    Mat_VarWrite(file, runs, MAT_COMPRESSION_NONE);
    Mat_VarFree(runs);
    matvar_t* const cells = Mat_VarCreate("channel", MAT_C_CELL, MAT_T_CELL, 2, two, nullptr, 0);
    Mat_VarSetCell(cells, 0, vector_of(second_signal, true));
    Mat_VarSetCell(cells, 1, vector_of(first_signal, false));
    Mat_VarWrite(file, cells, MAT_COMPRESSION_NONE);
    Mat_VarFree(cells);
    Mat_Close(file);
    EXPECT_THAT(read_table(made.path(), {}).names,
                testing::UnorderedElementsAre("run(1).tip.x", "run(2).tip.x", "channel{1}", "channel{2}"));
    RecordFormat format;
    format.channels = {{Quantity::acceleration, "channel{2}", 0, 9.80665},
                       {Quantity::force, "run(2).tip.x", 0, 1}};
    expect_both(read_record(made.path(), format), 1e-13);
  }
}

// A rate that contradicts the times beside it was ignored.
TEST(MatReader, RefusesARateThatContradictsTheTimes) {
  const TemporaryFile made("rate.mat", "");
  mat_t* const file = Mat_CreateVer(made.path().c_str(), nullptr, MAT_FT_MAT5);
  std::vector<double> times;
  for (int k = 0; k < samples; ++k) times.push_back(0.004 * k);
  write_variable(file, "t", samples, 1, times);
  write_variable(file, "Fs", 1, 1, {1000.0});
  write_variable(file, "acceleration_g", samples, 1, values_of(first_signal));
  Mat_Close(file);
  EXPECT_EQ(
      input_error_of(made, [&] { read_record(made.path()); }),
      "rate.mat: Fs means an interval of 0.001 s, and 't' has one of 0.004 s; expected them to agree, or "
      "record.time or record.sampling_rate_hz in the configuration");
  RecordFormat stated;
  stated.sampling_rate = 250;
  EXPECT_DOUBLE_EQ(read_record(made.path(), stated).interval(), 0.004);
}

void attribute(hid_t object, const char* name, const char* text) {
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, std::strlen(text));
  const hid_t id = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(id, type, text);
  H5Aclose(id), H5Sclose(space), H5Tclose(type);
}

void write_hdf5(const std::filesystem::path& path) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t group = H5Gcreate2(file, "run", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t length[2] = {samples, 2};
  const hid_t line = H5Screate_simple(1, length, nullptr), plane = H5Screate_simple(2, length, nullptr);
  const hid_t acceleration =
      H5Dcreate2(group, "tip", H5T_NATIVE_DOUBLE, line, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(acceleration, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values_of(first_signal).data());
  attribute(acceleration, "units", "g");
  const hid_t scalar = H5Screate(H5S_SCALAR);
  const hid_t rate =
      H5Acreate2(file, "sampling_rate_hz", H5T_NATIVE_DOUBLE, scalar, H5P_DEFAULT, H5P_DEFAULT);
  const double hertz = 100;
  H5Awrite(rate, H5T_NATIVE_DOUBLE, &hertz);
  std::vector<float> rows;
  for (int k = 0; k < samples; ++k)
    rows.insert(rows.end(), {static_cast<float>(k), static_cast<float>(second_signal(k))});
  const hid_t both =
      H5Dcreate2(group, "both", H5T_NATIVE_FLOAT, plane, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(both, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
  H5Aclose(rate), H5Sclose(scalar), H5Dclose(both), H5Dclose(acceleration), H5Sclose(line), H5Sclose(plane);
  H5Gclose(group), H5Fclose(file);
}

TEST(Hdf5Reader, ReadsDatasetsByPathWithTheirAttributes) {
  const TemporaryFile file("test.h5", "");
  write_hdf5(file.path());
  const Record stated = read_record(file.path());  // the unit of one dataset is known
  ASSERT_EQ(stated.channels.size(), 1u);
  EXPECT_EQ(stated.channels[0].name, "/run/tip");
  EXPECT_THAT(stated.remarks, testing::Contains(HasSubstr("'/run/both[:,0]' [], '/run/both[:,1]' []")));
  RecordFormat format;
  format.channels = {{Quantity::acceleration, "/run/tip", 0, 9.80665},
                     {Quantity::force, "/run/both[:,1]", 0, 1}};
  expect_both(read_record(file.path(), format), 1e-6);
}

// ---- delimited text, beyond what read_record_test.cpp holds

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
  format.skip_malformed = true, format.irregular = true;
  const Record record = read_record(file.path(), format);
  EXPECT_EQ(record.time, (Eigen::Vector4d(0, 0.1, 0.3, 0.4)));
  EXPECT_EQ(record.channel_names(), (std::vector<std::string>{"a", "b"}));
  EXPECT_THAT(
      record.remarks,
      ElementsAre("3 lines are left out, as each is not a row of numbers like the others: lines 5, 8, 10."));
  format.irregular = false;
  EXPECT_THAT(input_error_of(file, [&] { read_record(file.path(), format); }),
              HasSubstr("bad.txt:9:5: time 0.3 after 0.1"));
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
  format.skip_malformed = true;
  EXPECT_EQ(input_error_of(file, [&] { read_record(file.path(), format); }),
            "units.txt:1: 'acceleration_g' has the unit 'm/s2'; expected the one of its name");
}

// ---- damage

/// Reads a file a few hundred times with bytes changed, removed, doubled, or its end cut off: it is a record
/// or is refused in the usual way, and nothing else happens.
void fuzz(const std::string& name, const std::string& whole, const RecordFormat& format, unsigned seed,
          int rounds) {
  std::mt19937 random(seed);
  const auto below = [&](std::size_t limit) { return static_cast<std::size_t>(random()) % limit; };
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    std::string damaged = whole;
    for (std::size_t change = 0; change <= below(4); ++change) {
      const std::size_t at = below(damaged.size());
      switch (below(5)) {
        case 0:
          damaged[at] = static_cast<char>(below(256));
          break;
        case 1:
          damaged.erase(at, below(40));
          break;
        case 2:
          damaged.insert(at, damaged.substr(below(damaged.size()), below(60)));
          break;
        case 3:
          damaged[at] = static_cast<char>(damaged[at] ^ (1 << below(8)));
          break;
        default:
          damaged.resize(at + 1);
      }
    }
    const TemporaryFile file(name, damaged);
    try {
      const Record record = read_record(file.path(), format);
      EXPECT_EQ(record.samples.cols(), record.size());
      EXPECT_TRUE(record.samples.allFinite());
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, rounds / 20);
}

std::string bytes_of(const std::filesystem::path& path) {
  return read_bytes(path, "a file");
}

TEST(DamagedFiles, AreReadOrRefused) {
  fuzz("fuzz.lvm", lvm("Multi", ',', true), {}, 1, 300);
  fuzz("fuzz.lvm", lvm("No"), {}, 2, 300);
  fuzz("fuzz.uff", ascii_58(1, 4, true, "g", first_signal) + ascii_58(2, 2, false, "N", second_signal), {}, 3,
       300);
  fuzz("fuzz.unv", binary_58(1, 4, false, 2, "g", first_signal), {}, 4, 300);
  std::string text = "time_s,acceleration_g\n";
  for (int k = 0; k < samples; ++k)
    text += printed("%.2f", 0.01 * k) + "," + printed("%.6f", first_signal(k)) + "\n";
  RecordFormat tolerant;
  tolerant.skip_malformed = true;
  fuzz("fuzz.csv", text, {}, 5, 300);
  fuzz("fuzz.csv", text, tolerant, 6, 300);
}

TEST(DamagedFiles, OfMatlabAndHdf5AreReadOrRefused) {
  const TemporaryFile hdf("whole.h5", ""), five("whole5.mat", ""), seven("whole7.mat", "");
  write_hdf5(hdf.path());
  write_mat(five.path(), MAT_FT_MAT5);
  write_mat(seven.path(), MAT_FT_MAT73);
  fuzz("fuzz.h5", bytes_of(hdf.path()), {}, 7, 200);
  fuzz("fuzz5.mat", bytes_of(five.path()), mat_channels(), 8, 200);
  fuzz("fuzz7.mat", bytes_of(seven.path()), mat_channels(), 9, 100);
}

}  // namespace
}  // namespace beamid::experiments::record_files_test
