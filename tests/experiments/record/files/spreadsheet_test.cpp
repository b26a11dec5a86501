// Workbooks as spreadsheet programs store them: a sheet is the record that the same cells are as text, and
// what libfreexl does not give is refused.
#include <dlfcn.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/read_record.hpp"
#include "experiments/record/record_table.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/files/damaged_file.hpp"
#include "tests/experiments/record/files/written_workbook.hpp"

namespace beamid::experiments::spreadsheet_test {
namespace {

using testing::HasSubstr;

constexpr int count = 40;
double sample(int k) {
  return 0.1 * ((k * 37) % 101 - 50) / 3.0;
}

WrittenSheet record_of(const std::string& time, const std::string& signal) {
  WrittenSheet sheet{"Data", {{"Bridge, span 2"}, {}, {time, signal}}};
  for (int k = 0; k < count; ++k) sheet.rows.push_back({k * 0.0025, sample(k)});
  return sheet;
}

std::string refusal(const std::string& bytes, const RecordFormat& format = {}) {
  const TemporaryFile file("sheet.xls", bytes);
  return input_error_of(file, [&] { read_record(file.path(), format); });
}

TEST(Spreadsheet, IsTheRecordOfTheSameCellsAsText) {
  const WrittenSheet sheet = record_of("Time [s]", "acc [g]");
  std::string text;
  for (const auto& row : sheet.rows) {
    for (const SheetCell& cell : row) {
      text += &cell == row.data() ? "" : "\t";
      text += cell.kind == SheetCell::Kind::number ? fmt::format("{:.17g}", cell.value) : cell.text;
    }
    text += "\n";
  }
  const TemporaryFile workbook("a.xls", xls({sheet})), csv("a.txt", text);
  EXPECT_EQ(reader_of(workbook.path(), {}), "spreadsheet");
  const Record found = read_record(workbook.path(), {}), expected = read_record(csv.path(), {});
  ASSERT_EQ(found.size(), count);
  EXPECT_EQ(found.channels[0].quantity, Quantity::acceleration);
  EXPECT_EQ(found.channels[0].name, expected.channels[0].name);
  EXPECT_EQ(found.time, expected.time);
  EXPECT_EQ(found.samples, expected.samples);  // to the last bit
  EXPECT_EQ(found.samples(0, 7), sample(7) * 9.80665);
}

TEST(Spreadsheet, UnitsHaveARowAndCellsMayBeMissing) {
  WrittenSheet sheet{"Data", {{"t", "force", "acc"}, {"s", "kN", "m/s2"}}};
  for (int k = 0; k < count; ++k) sheet.rows.push_back({0.01 * k, 2.0 * (k + 1), -1.0 * k});
  sheet.rows[12][1] = SheetCell();
  const TemporaryFile file("a.xls", xls({sheet}));
  RecordFormat format;
  format.malformed = MalformedRows::as_missing;
  const Record record = read_record(file.path(), format);
  ASSERT_EQ(record.samples.rows(), 2);
  EXPECT_EQ(record.channels[0].quantity, Quantity::force);
  EXPECT_EQ(record.samples(0, 9), 20000.0);
  EXPECT_TRUE(std::isnan(record.samples(0, 10)));
  EXPECT_EQ(record.samples(1, 10), -10.0);
}

TEST(Spreadsheet, AFirstColumnThatIsEmptyShiftsNoOther) {
  WrittenSheet sheet = record_of("Time [s]", "acc [g]");
  for (auto& row : sheet.rows)
    if (!row.empty()) row.insert(row.begin(), SheetCell());
  const TemporaryFile file("a.xls", xls({sheet}));
  const Record record = read_record(file.path(), {});
  ASSERT_EQ(record.samples.rows(), 1);
  EXPECT_EQ(record.samples(0, 7), sample(7) * 9.80665);
  EXPECT_NEAR(record.interval(), 0.0025, 1e-15);
}

TEST(Spreadsheet, TheFirstSheetOfARecordIsReadAndOthersAreNamed) {
  const WrittenSheet notes{"Notes", {{"Rate", 400.0}, {"Mass", 1.2}, {"by", "A. N."}}};
  WrittenSheet second = record_of("Time [s]", "acc [g]");
  second.name = "Second run";
  const TemporaryFile file("a.xls", xls({notes, record_of("Time [s]", "acc [g]"), second}));
  const Record record = read_record(file.path(), {});
  EXPECT_EQ(record.size(), count);
  EXPECT_THAT(record.remarks,
              testing::Contains("Sheet 'Data' is read; not read: 'Notes' (2 rows of numbers), "
                                "'Second run' (40 rows of numbers)."));
  EXPECT_THAT(refusal(xls({{"Notes", {{"nothing"}, {1.0}}}})),
              HasSubstr("no sheet with two rows of numbers"));
}

TEST(Spreadsheet, DatesAreStampsToTheSecond) {
  const auto with_interval = [](double seconds) {
    WrittenSheet sheet{"Data", {{"Date", "acc [m/s2]"}}};
    for (int k = 0; k < count; ++k)
      sheet.rows.push_back({SheetCell::date(45352.4 + k * seconds / 86400.0), sample(k)});
    return xls({sheet});
  };
  const TemporaryFile slow("a.xls", with_interval(2.0)), fast("b.xls", with_interval(0.3));
  const Record record = read_record(slow.path(), {});
  EXPECT_NEAR(record.interval(), 2.0, 1e-9);
  EXPECT_EQ(record.samples(0, 3), sample(3));
  EXPECT_THAT(refusal(with_interval(0.3)), HasSubstr("sheet.xls:3:1: the same time as in the row above"));
  RecordFormat format;
  format.sampling_rate = 1.0 / 0.3;
  EXPECT_NEAR(read_record(fast.path(), format).interval(), 0.3, 1e-12);
  const TemporaryFile plain("c.xls", [] {  // numbers of days that no format shows as dates
    WrittenSheet sheet{"Data", {{"Date", "acc [m/s2]"}}};
    for (int k = 0; k < count; ++k) sheet.rows.push_back({45352.4 + k * 0.25 / 86400.0, sample(k)});
    return xls({sheet});
  }());
  EXPECT_NEAR(read_record(plain.path(), {}).interval(), 0.25, 1e-5);
}

TEST(Spreadsheet, FormulasAreRefusedAndNotTakenForMissing) {
  for (const std::size_t column : {0U, 1U}) {
    WrittenSheet sheet = record_of("Time [s]", "acc [g]");
    for (std::size_t row = 4; row < sheet.rows.size(); ++row) sheet.rows[row][column] = SheetCell::formula();
    EXPECT_THAT(
        refusal(xls({sheet})),
        HasSubstr(column == 0 ? "sheet.xls: 'Time [s]' (cell A3) is empty in 39 of 40 rows, as formulas are"
                              : "sheet.xls: 'acc [g]' (cell B3) is empty in 39 of 40 rows"));
  }
}

TEST(Spreadsheet, MessagesGiveRowAndColumnOfTheSheet) {
  WrittenSheet sheet = record_of("Time [s]", "acc [g]");
  sheet.rows[20][1] = "1.2.3";
  EXPECT_THAT(refusal(xls({sheet})), HasSubstr("sheet.xls:21:2: "));
  EXPECT_THAT(refusal(xls({record_of("Time [s]", "acc [g]")}, true)),
              HasSubstr("a workbook with a password"));
}

TEST(Spreadsheet, ZipArchivesAreToldApartByTheirFirstEntry) {
  for (const auto& [bytes, reader] :
       {std::pair{zip_of({{"[Content_Types].xml", "<Types/>"}}), "spreadsheet"},
        {zip_of({{"docProps/app.xml", "<Properties/>"}}), "spreadsheet"},
        {zip_of({{"mimetype", type_of_ods}}), "spreadsheet"},
        {zip_of({{"mimetype", "application/vnd.oasis.opendocument.text"}}), "delimited_text"},
        {zip_of({{"a.npy", "\x93NUMPY"}}), "npy"},
        {zip_of({{"xl/a.npy", "\x93NUMPY"}}), "npy"},
        {zip_of({{"readme.txt", "text"}}), "delimited_text"}}) {
    const TemporaryFile file("archive", bytes);
    EXPECT_EQ(reader_of(file.path(), {}), reader);
  }
}

bool reads_new_kinds() {
  void* const library = dlopen("libfreexl.so.1", RTLD_NOW | RTLD_LOCAL);
  return library != nullptr && dlsym(library, "freexl_open_xlsx") != nullptr;
}

TEST(Spreadsheet, NewKindsAreReadOrNamedByTheLibraryOfTheSystem) {
  WrittenSheet sheet = record_of("Time [s]", "acc [g]");
  const std::string whole = "<t>acc [g]</t>", old = "of this system reads xls only; save the sheet as CSV";
  if (!reads_new_kinds()) {
    EXPECT_THAT(refusal(xlsx(sheet, whole)), HasSubstr("sheet.xls: an xlsx workbook: libfreexl 1"));
    EXPECT_THAT(refusal(xlsx(sheet, whole)), HasSubstr(old));
    EXPECT_THAT(refusal(ods(sheet)), HasSubstr(old));
    return;
  }
  for (const std::string& bytes : {xlsx(sheet, whole), ods(sheet)}) {
    const TemporaryFile file("sheet", bytes);
    const Record record = read_record(file.path(), {});
    ASSERT_EQ(record.size(), count);
    for (int k = 0; k < count; ++k) EXPECT_EQ(record.samples(0, k), sample(k) * 9.80665);
  }
  EXPECT_THAT(refusal(xlsx(sheet, "<r><t>acc [cm/s</t></r><r><t>2</t></r><r><t>]</t></r>")),
              HasSubstr("']' (cell B3) is the end of a text in several fonts"));
  for (auto& row : sheet.rows) row.resize(std::min<std::size_t>(row.size(), 1));
  EXPECT_THAT(refusal(xlsx({"Data", {sheet.rows.begin() + 3, sheet.rows.end()}}, "")),
              HasSubstr("without names above its numbers"));
  EXPECT_THAT(refusal(ods(sheet, 3)),
              HasSubstr("row 43 is empty beside rows of numbers, as equal rows of ods"));
}

TEST(Spreadsheet, AreRefusedWhereTheyAreDamaged) {
  RecordFormat format;
  format.time.emplace().number = 1;
  format.channels.emplace_back().number = 2;
  expect_read_or_refused("a.xls", xls({record_of("Time [s]", "acc [g]")}), format, 7, 200);
}

}  // namespace
}  // namespace beamid::experiments::spreadsheet_test
