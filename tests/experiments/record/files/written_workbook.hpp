// Workbooks written byte by byte, for tests of their reader.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace beamid::experiments {

struct SheetCell {
  enum class Kind { empty, number, text, date_and_time, formula };
  SheetCell() = default;
  SheetCell(double number) : kind(Kind::number), value(number) {}  // NOLINT(google-explicit-constructor)
  SheetCell(const char* words) : kind(Kind::text), text(words) {}  // NOLINT(google-explicit-constructor)
  SheetCell(const std::string& words)
      : kind(Kind::text), text(words) {}  // NOLINT(google-explicit-constructor)
  static SheetCell date(double days) {
    SheetCell cell(days);
    cell.kind = Kind::date_and_time;
    return cell;
  }
  static SheetCell formula() {
    SheetCell cell;
    cell.kind = Kind::formula;
    return cell;
  }

  Kind kind = Kind::empty;
  double value = 0.0;  ///< of a date: days since 30 December 1899
  std::string text;
};
struct WrittenSheet {
  std::string name;
  std::vector<std::vector<SheetCell>> rows;
};

/// Excel 97: BIFF8 records [biff8] in an OLE2 container [cfb]; at most 62 KiB of them.
/// @param secret states that it has a password
std::string xls(const std::vector<WrittenSheet>& sheets, bool secret = false);

/// A zip archive [zip] of entries that are not compressed: their names and contents.
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& entries);

/// Office Open XML. @param second_column its names, as XML of a shared string: "<t>acc [g]</t>"
std::string xlsx(const WrittenSheet& sheet, const std::string& second_column);

inline constexpr const char* type_of_ods = "application/vnd.oasis.opendocument.spreadsheet";

/// OpenDocument. @param repeated how often its last row is
std::string ods(const WrittenSheet& sheet, int repeated = 1);

}  // namespace beamid::experiments
