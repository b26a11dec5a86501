// Workbooks of Excel and of OpenDocument, through libfreexl [freexl]: a sheet is read as the delimited text
// it would be saved as, so that its names, units, stamps and gaps are recognised as those of a CSV file are.
//
// What the library does not give is never made up. Formulas of xls come as empty cells, dates and times of
// day rounded to whole seconds; of xlsx and ods, texts in several fonts come in part, those in the cells
// themselves (most programs collect them in a table) and equal rows as empty cells. Where that would change
// what is read, the file is refused with the remedy.
#include <fmt/format.h>
#include <freexl.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <needed_library.hpp>
#include "experiments/record/delimited_text.hpp"
#include "experiments/record/read_apart.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

constexpr const char* save_sheet_as_csv = "save the sheet as CSV";

// What a workbook begins with.

struct WorkbookKind {
  const char* name;  ///< for messages
  const char* open;  ///< the function that opens it; all but the first are of libfreexl 2
};
constexpr WorkbookKind xls{"an xls workbook", "freexl_open"}, xlsx{"an xlsx workbook", "freexl_open_xlsx"},
    ods{"an ods workbook", "freexl_open_ods"};

/// The name of a zip archive's first entry, and what follows it: behind 30 bytes, two of which hold its
/// length [zip].
std::pair<std::string_view, std::string_view> first_entry(std::string_view archive) {
  constexpr std::size_t fixed = 30, length_at = 26;
  if (!archive.starts_with("PK\x03\x04") || archive.size() < fixed) return {};
  const auto byte = [&](std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(archive[at]));
  };
  const std::size_t length = byte(length_at) | byte(length_at + 1) << 8;
  archive.remove_prefix(fixed);
  return {archive.substr(0, length), archive.substr(std::min(length, archive.size()))};
}

/// The container of Excel 97 begins with its eight bytes; the newer kinds are zip archives, as NumPy's are
/// (npy.cpp), whose first entry shows what they hold. Programs begin xlsx with one of these four.
std::optional<WorkbookKind> workbook_kind(std::string_view beginning) {
  if (beginning.starts_with("\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1")) return xls;
  const auto [name, content] = first_entry(beginning);
  if (name == "mimetype" && content.starts_with("application/vnd.oasis.opendocument.spreadsheet")) return ods;
  if (name.ends_with(".npy")) return {};
  if (name == "[Content_Types].xml" || name == "_rels/.rels" || name.starts_with("docProps/") ||
      name.starts_with("xl/"))
    return xlsx;
  return {};
}

// A sheet as text.

constexpr NeededLibrary freexl{"libfreexl.so.1", "libfreexl1"};
BEAMID_NEEDED(freexl, freexl_get_cell_value);
BEAMID_NEEDED(freexl, freexl_get_info);
BEAMID_NEEDED(freexl, freexl_get_worksheet_name);
BEAMID_NEEDED(freexl, freexl_select_active_worksheet);
BEAMID_NEEDED(freexl, freexl_version);
BEAMID_NEEDED(freexl, freexl_worksheet_dimensions);

/// The cells of the sheet that is selected.
class SheetCells {
 public:
  explicit SheetCells(const void* workbook) : workbook_(workbook) {
    constexpr unsigned most_rows = 1U << 20, most_columns = 1U << 14;  // of any kind of workbook
    unsigned short columns = 0;
    const bool found = freexl_worksheet_dimensions(workbook, &rows, &columns) == FREEXL_OK;
    width = columns;
    if (!found || rows > most_rows || width > most_columns || width == 0) rows = 0, width = 0;
  }

  FreeXL_CellValue at(unsigned row, unsigned column) const {
    FreeXL_CellValue cell{};
    if (freexl_get_cell_value(workbook_, row, static_cast<unsigned short>(column), &cell) != FREEXL_OK)
      cell.type = FREEXL_CELL_NULL;
    return cell;
  }

  bool is_empty(unsigned row) const {
    for (unsigned column = 0; column < width; ++column)
      if (at(row, column).type != FREEXL_CELL_NULL) return false;
    return true;
  }

  bool holds_number(unsigned row) const {
    for (unsigned column = 0; column < width; ++column) {
      const unsigned char type = at(row, column).type;
      if (type != FREEXL_CELL_NULL && type != FREEXL_CELL_TEXT && type != FREEXL_CELL_SST_TEXT) return true;
    }
    return false;
  }

  unsigned rows = 0, width = 0;

 private:
  const void* workbook_;
};

unsigned rows_of_numbers(const SheetCells& cells) {
  unsigned count = 0;
  for (unsigned row = 0; row < cells.rows; ++row) count += cells.holds_number(row);
  return count;
}

/// A cell as a field: numbers to the last bit, texts on one line.
std::string field_of(const FreeXL_CellValue& cell) {
  if (cell.type == FREEXL_CELL_INT) return std::to_string(cell.value.int_value);
  if (cell.type == FREEXL_CELL_DOUBLE)
    return std::isfinite(cell.value.double_value) ? fmt::format("{}", cell.value.double_value) : "NaN";
  if (cell.type == FREEXL_CELL_NULL || cell.value.text_value == nullptr) return "";
  std::string text = clean_text(cell.value.text_value);
  return text.find('"') == std::string::npos ? text : csv_field(text);
}

/// A line for each row, so that lines of messages are rows of the sheet; each with all separators, as
/// spreadsheets save them.
std::string text_of(const SheetCells& cells) {
  std::vector<std::string> lines;
  std::vector<unsigned> ends;  // behind the last cell of each row
  unsigned width = 0;
  for (unsigned row = 0; row < cells.rows; ++row) {
    std::string line;
    unsigned end = 0, written = 0;
    for (unsigned column = 0; column < cells.width; ++column) {
      const std::string field = field_of(cells.at(row, column));
      if (field.empty()) continue;
      line.append(column - written, '\t').append(field);
      written = column, end = column + 1;
    }
    width = std::max(width, end);
    lines.push_back(std::move(line)), ends.push_back(end);
  }
  std::string text;
  for (std::size_t row = 0; row < lines.size(); ++row) {
    text += lines[row];
    if (ends[row] > 0) text.append(width - ends[row], '\t');
    text += '\n';
  }
  return text;
}

/// "B3", as spreadsheets name a cell.
std::string name_of_cell(unsigned row, unsigned column) {
  constexpr unsigned letters = 26;
  std::string name;
  for (unsigned left = column + 1; left > 0; left = (left - 1) / letters)
    name.insert(name.begin(), static_cast<char>('A' + (left - 1) % letters));
  return name + std::to_string(row + 1);
}

/// The longest run of rows with numbers, and the row behind it.
std::pair<unsigned, unsigned> longest_run(const SheetCells& cells) {
  unsigned first = 0, last = 0;
  for (unsigned row = 0, from = 0; row < cells.rows; ++row)
    if (!cells.holds_number(row))
      from = row + 1;
    else if (row + 1 - from > last - first)
      first = from, last = row + 1;
  return {first, last};
}

/// Of rows of an ods sheet that are equal, and are stored as one, libfreexl 2.0.0 gives the last and empty
/// ones before it: samples would be lost. @throws InputError
void refuse_repeated_rows(const std::string& file, const SheetCells& cells) {
  const auto [first, last] = longest_run(cells);
  bool more = false;
  for (unsigned row = last; row < cells.rows; ++row) more = more || cells.holds_number(row);
  const bool before = first > 0 && cells.is_empty(first - 1);
  if (before || (more && cells.is_empty(last)))
    throw InputError({file, 0, 0},
                     fmt::format("row {} is empty beside rows of numbers, as equal rows of ods are, which "
                                 "libfreexl does not give; expected no empty row: {}",
                                 before ? first : last + 1, save_sheet_as_csv));
}

/// Of a text in several fonts, "cm/s" and a raised "2", libfreexl 2.0.0 gives the last part: a bracket that
/// is not opened shows it. @throws InputError
void refuse_parts_of_texts(const std::string& file, const SheetCells& cells) {
  const unsigned first = longest_run(cells).first;
  for (unsigned row = 0; row < first; ++row)
    for (unsigned column = 0; column < cells.width; ++column) {
      const std::string text = field_of(cells.at(row, column));
      for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}})
        if (std::ranges::count(text, close) > std::ranges::count(text, open))
          throw InputError(
              {file, 0, 0},
              fmt::format("'{}' (cell {}) is the end of a text in several fonts, of which libfreexl "
                          "does not give the rest; expected one font, or {}",
                          text, name_of_cell(row, column), save_sheet_as_csv));
    }
}

/// Columns that are named as times or a quantity, and are empty in half of the rows of the longest run or
/// more: formulas. @throws InputError
void refuse_formulas(const std::string& file, const SheetCells& cells) {
  constexpr unsigned most_header_rows = 4;  // as in delimited text
  const auto [first, last] = longest_run(cells);
  for (unsigned column = 0; column < cells.width; ++column) {
    unsigned empty = 0;
    for (unsigned row = first; row < last; ++row) empty += cells.at(row, column).type == FREEXL_CELL_NULL;
    if (2 * empty < last - first) continue;
    for (unsigned row = first; row-- > 0 && first - row <= most_header_rows;) {
      const std::string name = field_of(cells.at(row, column));
      const auto found = recognise_column(unquoted(name), "");
      if (name.empty() || (found && found->kind != RecognisedColumn::Kind::time && !found->states_quantity))
        continue;
      throw InputError(
          {file, 0, 0},
          fmt::format(
              "'{}' (cell {}) is empty in {} of {} rows, as formulas are, whose results libfreexl does "
              "not give; expected numbers: copy the column and paste it as values, or {}",
              name, name_of_cell(row, column), empty, last - first, save_sheet_as_csv));
    }
  }
}

/// The sheet's text, and a sentence on the others. It is the first that has as many rows of numbers as a
/// record needs, as a sheet of notes may have a few; failing that, the first that has two.
std::vector<std::string> read_sheet(const std::string& file, const WorkbookKind& kind,
                                    std::size_t most_cells) {
  constexpr unsigned most_sheets = 1024, fewest = 2, of_a_record = 16;
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    return InputError({file, 0, 0}, fmt::format("{}; expected {}", found, expected));
  };
  if (freexl.there() && !freexl.has(kind.open))
    throw InputError({file, 0, 0}, fmt::format("{}: libfreexl {} of this system reads xls only; {}",
                                               kind.name, freexl_version(), save_sheet_as_csv));
  const void* workbook = nullptr;
  const int failure =
      reinterpret_cast<decltype(&freexl_open)>(freexl.symbol(kind.open))(file.c_str(), &workbook);
  if (failure != FREEXL_OK)
    throw refuse(fmt::format("no workbook that libfreexl reads (error {})", failure),
                 fmt::format("{}, or {}", kind.name, save_sheet_as_csv));
  unsigned secret = 0;
  if (freexl_get_info(workbook, FREEXL_BIFF_PASSWORD, &secret) == FREEXL_OK &&
      secret == FREEXL_BIFF_OBFUSCATED)
    throw refuse("a workbook with a password", "one without");

  const auto select = [&](unsigned sheet) {
    return freexl_select_active_worksheet(workbook, static_cast<unsigned short>(sheet)) == FREEXL_OK;
  };
  struct Sheet {
    unsigned number, rows;
    std::string name;
  };
  std::vector<Sheet> sheets;  // that hold anything
  for (unsigned k = 0; k < most_sheets && select(k); ++k) {
    const SheetCells cells(workbook);
    if (static_cast<std::size_t>(cells.rows) * cells.width > most_cells)
      throw refuse(fmt::format("sheet {} claims {} x {} cells", k + 1, cells.rows, cells.width),
                   fmt::format("at most {:.3g}, which a file of this size can hold", double(most_cells)));
    const char* name = nullptr;
    freexl_get_worksheet_name(workbook, static_cast<unsigned short>(k), &name);
    if (cells.rows > 0) sheets.push_back({k, rows_of_numbers(cells), clean_text(name ? name : "")});
  }
  const auto with = [&](unsigned rows) {
    return std::ranges::find_if(sheets, [&](const Sheet& sheet) { return sheet.rows >= rows; });
  };
  auto chosen = with(of_a_record);
  if (chosen == sheets.end()) chosen = with(fewest);
  if (chosen == sheets.end())
    throw refuse(fmt::format("no sheet with two rows of numbers among {}", sheets.size()),
                 "values: results of formulas are pasted as values, or " + std::string(save_sheet_as_csv));
  select(chosen->number);
  const SheetCells cells(workbook);
  refuse_formulas(file, cells);
  if (kind.open != xls.open) refuse_parts_of_texts(file, cells);
  if (kind.open == ods.open) refuse_repeated_rows(file, cells);
  std::string others;
  for (const Sheet& sheet : sheets)
    if (sheet.number != chosen->number)
      others +=
          fmt::format("{}'{}' ({} rows of numbers)", others.empty() ? "" : ", ", sheet.name, sheet.rows);
  return {text_of(cells),
          others.empty() ? "" : fmt::format("Sheet '{}' is read; not read: {}.", chosen->name, others)};
}

// What the library does not give.

/// Stamps that repeat, where they alone give the rate. @throws InputError at the first that does
void refuse_rounded_stamps(const RecordTable& table, const RecordFormat& format) {
  if (!table.time || format.time || format.sampling_rate) return;
  const std::vector<double>& stamps = table.columns[*table.time];
  for (std::size_t row = 1; row < stamps.size(); ++row)
    if (stamps[row] == stamps[row - 1])
      throw InputError(
          table.place(row, *table.time),
          fmt::format(
              "the same time as in the row above, as libfreexl rounds dates and times of day to whole "
              "seconds; expected the rate beside them (--rate, or record.sampling_rate_hz in the "
              "configuration), or {} with fractions of a second",
              save_sheet_as_csv));
}

/// Places count characters of the text; those of a sheet count columns.
Place cell_place(const Place& place, std::string_view text) {
  if (place.line == 0 || place.column == 0) return place;
  for (std::size_t line = 1; line < place.line; ++line)
    text.remove_prefix(std::min(text.find('\n') + 1, text.size()));
  const std::string_view before = text.substr(0, place.column - 1);
  return {place.file, place.line, static_cast<std::size_t>(std::ranges::count(before, '\t')) + 1};
}

class SpreadsheetReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override { return workbook_kind(beginning).has_value(); }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    const std::size_t bytes = count_bytes(file, "a workbook");
    std::string beginning(1024, '\0');
    std::ifstream stream = open_input(file, "a workbook");
    stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    const auto kind = workbook_kind(beginning);
    if (!kind)
      throw InputError({file.string(), 0, 0}, "no workbook by its beginning; expected xls, xlsx or ods");
    const ReadingLimits limits = reading_limits(bytes);
    std::vector<std::string> texts = texts_apart(
        file.string(), "libfreexl", limits, [&] { return read_sheet(file.string(), *kind, limits.numbers); });
    texts.resize(2);
    const std::string text = std::move(texts[0]);
    RecordFormat of_text = format;
    of_text.separator = '\t', of_text.decimal = '\0';  // of the text above, whatever is stated of others
    RecordTable table;
    try {
      table = table_of_text(file.string(), text, of_text);
    } catch (const InputError& error) {
      const Place place{error.file(), error.line(), error.column()};
      throw InputError(cell_place(place, text),
                       std::string(error.what()).substr(to_string(place).size() + 2));
    }
    if (table.cell)
      table.cell = [cell = table.cell](std::size_t row, std::size_t column) {
        TextField field = cell(row, column);
        field.place.column = column + 1;
        return field;
      };
    if (kind->open != xls.open && table.names.empty())
      throw InputError({file.string(), 0, 0},
                       fmt::format("{} without names above its numbers that libfreexl reads; expected a row "
                                   "of them: save it anew by a spreadsheet program, or {}",
                                   kind->name, save_sheet_as_csv));
    refuse_rounded_stamps(table, format);
    if (!texts[1].empty()) table.remarks.push_back(texts[1]);
    return table;
  }
};

const bool spreadsheet_registered = record_reader_registry().add(
    {"spreadsheet",
     "workbooks, xls, and with libfreexl 2 xlsx and ods: the first sheet of numbers, read as delimited text",
     "[freexl]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<SpreadsheetReader>(); }});

}  // namespace
}  // namespace beamid::experiments
