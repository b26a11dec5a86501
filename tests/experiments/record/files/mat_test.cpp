// MATLAB files of both levels: what is read, what is refused.
// Oracles: the numbers written into the files, by hand from the formats' descriptions or by the libraries.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include "experiments/record/read_record.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/toml_table.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/files/damaged_file.hpp"
#include "tests/experiments/record/files/written_record.hpp"

namespace beamid::experiments::mat_test {
namespace {

using testing::HasSubstr;

void write_variable(mat_t* file, const char* name, std::size_t rows, std::size_t columns,
                    std::vector<double> values) {
  std::size_t size[2] = {rows, columns};
  matvar_t* const variable = Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, values.data(), 0);
  Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE);
  Mat_VarFree(variable);
}

/// dt, a row vector acceleration_g, and data.hammer, a column vector in a struct.
void write_mat(const std::filesystem::path& path, mat_ft version) {
  mat_t* const file = Mat_CreateVer(path.c_str(), nullptr, version);
  ASSERT_NE(file, nullptr);
  write_variable(file, "dt", 1, 1, {0.01});
  write_variable(file, "acceleration_g", 1, written_samples, values_of(first_signal));
  std::vector<double> both = values_of(second_signal), copy = both;
  both.insert(both.end(), copy.begin(), copy.end());
  std::size_t one[2] = {1, 1}, size[2] = {written_samples, 2};
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
  std::size_t size[2] = {as_row ? 1u : written_samples, as_row ? written_samples : 1u};
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
  for (int k = 0; k < written_samples; ++k) times.push_back(0.004 * k);
  write_variable(file, "t", written_samples, 1, times);
  write_variable(file, "Fs", 1, 1, {1000.0});
  write_variable(file, "acceleration_g", written_samples, 1, values_of(first_signal));
  Mat_Close(file);
  EXPECT_EQ(
      input_error_of(made, [&] { read_record(made.path()); }),
      "rate.mat: Fs means an interval of 0.001 s, and 't' has one of 0.004 s; expected them to agree, or "
      "record.time or record.sampling_rate_hz in the configuration");
  RecordFormat stated;
  stated.sampling_rate = 250;
  EXPECT_DOUBLE_EQ(read_record(made.path(), stated).interval(), 0.004);
}

void write_text(mat_t* file, const char* name, std::string text) {
  std::size_t size[2] = {1, text.size()};
  matvar_t* const variable = Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, 2, size, text.data(), 0);
  Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE);
  Mat_VarFree(variable);
}

// Oracle: 9.80665 m/s2 to one g; the rate of the shaft is no rate of samples.
TEST(MatReader, TakesUnitsAndRatesFromVariablesBeside) {
  const TemporaryFile made("beside.mat", "");
  mat_t* const file = Mat_CreateVer(made.path().c_str(), nullptr, MAT_FT_MAT5);
  write_variable(file, "acc", written_samples, 1, values_of(first_signal));
  write_variable(file, "sr", 1, 1, {100.0});
  write_variable(file, "rate", 1, 1, {25.0});
  write_text(file, "unit", "g");
  Mat_Close(file);
  const Record record = read_record(made.path());
  EXPECT_DOUBLE_EQ(record.interval(), 0.01);
  EXPECT_NEAR(record.samples(0, 3), 9.80665 * first_signal(3), 1e-12);
}

// Oracle: what was written. A unit whose name states a signal is that signal's; another is that of the rest.
TEST(MatReader, TakesTheUnitsThatStandBesideTheSignals) {
  for (const bool alone : {true, false}) {
    const TemporaryFile made("units.mat", "");
    mat_t* const file = Mat_CreateVer(made.path().c_str(), nullptr, MAT_FT_MAT5);
    write_variable(file, "fs", 1, 1, {100.0});
    write_variable(file, "acc", written_samples, 1, values_of(first_signal));
    if (!alone) write_variable(file, "hammer", written_samples, 1, values_of(second_signal));
    write_text(file, alone ? "units" : "hammer_unit", alone ? "g" : "kN");
    if (!alone) write_text(file, "unit", "g");
    Mat_Close(file);
    const RecordTable table = read_table(made.path(), {});
    EXPECT_THAT(table.units, testing::ElementsAreArray(alone ? std::vector<std::string>{"g"}
                                                             : std::vector<std::string>{"g", "kN"}));
  }
}

// CWRU's names end in "time", MFPT's files have a rate beside that of the samples.
TEST(MatReader, ReadsBearingData) {
  const TemporaryFile made("bearing.mat", "");
  mat_t* const file = Mat_CreateVer(made.path().c_str(), nullptr, MAT_FT_MAT5);
  write_variable(file, "sr", 1, 1, {100.0});
  write_variable(file, "rate", 1, 1, {25.0});
  write_variable(file, "X097_DE_time", written_samples, 1, values_of(second_signal));
  Mat_Close(file);
  const Record record = read_record(made.path());
  EXPECT_DOUBLE_EQ(record.interval(), 0.01);
  ASSERT_EQ(record.channels.size(), 1u);
  EXPECT_EQ(record.channels[0].name, "X097_DE_time");
}

// Oracle: the format's description: type, rows, columns, imaginary part, length of the name; then both.
TEST(MatReader, ReadsLevelFour) {
  std::string bytes;
  const auto put = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto matrix = [&](std::string name, std::int32_t rows, const std::vector<double>& values) {
    name += '\0';
    for (const std::int32_t one : {0, rows, 1, 0, static_cast<int>(name.size())}) put(one);
    bytes += name;
    for (const double value : values) put(value);
  };
  matrix("dt", 1, {0.01});
  matrix("acceleration_g", written_samples, values_of(first_signal));
  matrix("hammer", written_samples, values_of(second_signal));
  const TemporaryFile file("level4.mat", bytes);
  RecordFormat format = mat_channels();
  format.channels[1].name = "hammer";
  expect_both(read_record(file.path(), format), 1e-13);
}

// Oracle: what Octave's save writes of these (its manual, "Simple File I/O").
TEST(OctaveText, IsReadWithItsRateAndUnits) {
  std::string text =
      "# Created by Octave 8.4.0, Mon Nov 30 12:00:00 2026 UTC <u@h>\n# name: fs\n# type: scalar\n100\n\n\n";
  text += fmt::format("# name: acc\n# type: matrix\n# rows: {}\n# columns: 2\n",
                      static_cast<int>(written_samples));
  const std::vector<double> first = values_of(first_signal), second = values_of(second_signal);
  for (std::size_t k = 0; k < first.size(); ++k)
    text += fmt::format(" {:.17g} {:.17g}\n", first[k], second[k]);
  text += "\n\n# name: acc_unit\n# type: string\n# elements: 1\n# length: 1\ng\n\n\n";
  const TemporaryFile file("acc.txt", text);
  const RecordTable table = read_table(file.path(), {});
  EXPECT_THAT(table.names, testing::ElementsAre("acc(:,1)", "acc(:,2)"));
  EXPECT_THAT(table.units, testing::ElementsAre("g", "g"));
  EXPECT_EQ(table.columns[1], second);
  EXPECT_DOUBLE_EQ(read_record(file.path()).interval(), 0.01);
  const TemporaryFile cut("cut.txt", text.substr(0, 400));
  EXPECT_THAT(input_error_of(cut, [&] { read_table(cut.path(), {}); }), HasSubstr("'acc' holds"));
}

TEST(MatReader, ReadsOrRefusesDamagedFiles) {
  const TemporaryFile five("whole5.mat", ""), seven("whole7.mat", "");
  write_mat(five.path(), MAT_FT_MAT5);
  write_mat(seven.path(), MAT_FT_MAT73);
  expect_read_or_refused("fuzz5.mat", read_bytes(five.path(), "a file"), mat_channels(), 8, 200);
  expect_read_or_refused("fuzz7.mat", read_bytes(seven.path(), "a file"), mat_channels(), 9, 100);
}

}  // namespace
}  // namespace beamid::experiments::mat_test
