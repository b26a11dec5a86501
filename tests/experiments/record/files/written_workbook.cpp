#include "tests/experiments/record/files/written_workbook.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace beamid::experiments {
namespace {

template <class Number>
std::string bytes_of(Number value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

std::string words(std::initializer_list<unsigned> values) {
  std::string bytes;
  for (const unsigned value : values) bytes += bytes_of(static_cast<std::uint16_t>(value));
  return bytes;
}

std::string biff(unsigned kind, const std::string& content) {
  return words({kind, static_cast<unsigned>(content.size())}) + content;
}

constexpr unsigned begin = 0x809, end = 0x0A, code_page = 0x42, format_of_cells = 0xE0, bound_sheet = 0x85,
                   dimensions = 0x200, number = 0x203, label_of_table = 0xFD, table_of_strings = 0xFC,
                   formula = 0x06, password = 0x2F;

/// The stream "Workbook": strings in one table, then the sheets, whose places their first records state.
std::string workbook_stream(const std::vector<WrittenSheet>& sheets, bool secret) {
  std::string strings;
  std::uint32_t count = 0;
  std::vector<std::string> bodies;
  for (const WrittenSheet& sheet : sheets) {
    std::size_t width = 0;
    for (const auto& row : sheet.rows) width = std::max(width, row.size());
    std::string body = biff(begin, words({0x600, 0x10, 0, 0, 0, 0, 0, 0}));
    body += biff(dimensions, bytes_of<std::uint32_t>(0) +
                                 bytes_of(static_cast<std::uint32_t>(sheet.rows.size())) +
                                 words({0, static_cast<unsigned>(width), 0}));
    for (unsigned row = 0; row < sheet.rows.size(); ++row)
      for (unsigned column = 0; column < sheet.rows[row].size(); ++column) {
        const SheetCell& cell = sheet.rows[row][column];
        switch (cell.kind) {
          case SheetCell::Kind::empty:
            break;
          case SheetCell::Kind::number:
            body += biff(number, words({row, column, 0}) + bytes_of(cell.value));
            break;
          case SheetCell::Kind::date_and_time:
            body += biff(number, words({row, column, 1}) + bytes_of(cell.value));
            break;
          case SheetCell::Kind::formula:
            body += biff(formula, words({row, column, 0}) + bytes_of(1.5) + std::string(8, '\0'));
            break;
          case SheetCell::Kind::text:
            body += biff(label_of_table, words({row, column, 0}) + bytes_of(count++));
            strings += words({static_cast<unsigned>(cell.text.size())}) + '\0' + cell.text;
        }
      }
    bodies.push_back(body + biff(end, ""));
  }
  const auto globals = [&](const std::vector<std::uint32_t>& places) {
    std::string text = biff(begin, words({0x600, 0x05, 0, 0, 0, 0, 0, 0}));
    if (secret) text += biff(password, words({0, 0x1234, 0x5678}));
    text += biff(code_page, words({1200}));
    for (const unsigned format : {0U, 22U})
      text += biff(format_of_cells, words({0, format}) + std::string(16, '\0'));
    for (std::size_t k = 0; k < sheets.size(); ++k)
      text += biff(bound_sheet, bytes_of(places[k]) + words({0}) + static_cast<char>(sheets[k].name.size()) +
                                    '\0' + sheets[k].name);
    return text + biff(table_of_strings, bytes_of(count) + bytes_of(count) + strings) + biff(end, "");
  };
  std::vector<std::uint32_t> places(sheets.size());
  std::size_t place = globals(places).size();
  for (std::size_t k = 0; k < sheets.size(); place += bodies[k++].size())
    places[k] = static_cast<std::uint32_t>(place);
  std::string stream = globals(places);
  for (const std::string& body : bodies) stream += body;
  return stream;
}

/// The container: a header, one sector of the allocation table, one of the directory, then the stream.
}  // namespace

std::string xls(const std::vector<WrittenSheet>& sheets, bool secret) {
  constexpr std::size_t sector = 512, least = 4096;  // shorter streams are stored otherwise
  constexpr std::uint32_t free_sector = 0xFFFFFFFF, last = 0xFFFFFFFE, of_table = 0xFFFFFFFD;
  std::string stream = workbook_stream(sheets, secret);
  stream.resize(std::max(least, (stream.size() + sector - 1) / sector * sector));
  const auto length = static_cast<std::uint32_t>(stream.size()), count = length / std::uint32_t{sector};
  std::string header("\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", 8);
  header += std::string(16, '\0') + words({0x3E, 3, 0xFFFE, 9, 6, 0, 0, 0, 0, 0});
  for (const std::uint32_t value : {1U, 1U, 0U, 4096U, last, 0U, last, 0U, 0U}) header += bytes_of(value);
  while (header.size() < sector) header += bytes_of(free_sector);
  std::string table = bytes_of(of_table) + bytes_of(last);
  for (std::uint32_t k = 0; k < count; ++k) table += bytes_of(k + 1 < count ? k + 3 : last);
  EXPECT_LE(table.size(), sector);
  while (table.size() < sector) table += bytes_of(free_sector);
  const auto entry = [&](const std::string& name, char kind, std::uint32_t child, std::uint32_t start,
                         std::uint32_t size) {
    std::string text;
    for (const char letter : name) text += std::string{letter, '\0'};
    text.resize(64);
    text += words({static_cast<unsigned>(2 * name.size() + 2)}) + kind + '\1';
    text += bytes_of(free_sector) + bytes_of(free_sector) + bytes_of(child) + std::string(36, '\0');
    return text + bytes_of(start) + bytes_of(size) + bytes_of<std::uint32_t>(0);
  };
  std::string directory = entry("Root Entry", 5, 1, last, 0) + entry("Workbook", 2, free_sector, 2, length);
  directory.resize(sector);
  return header + table + directory + stream;
}

// The newer kinds: archives of XML.

namespace {

/// The check sum of zip archives, bit by bit.
std::uint32_t crc_of(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

}  // namespace

std::string zip_of(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string files, directory;
  for (const auto& [name, content] : entries) {
    const auto size = static_cast<std::uint32_t>(content.size());
    const std::string about = words({20, 0, 0, 0, 0}) + bytes_of(crc_of(content)) + bytes_of(size) +
                              bytes_of(size) + words({static_cast<unsigned>(name.size()), 0});
    directory += "PK\x01\x02" + words({20}) + about + std::string(10, '\0') +
                 bytes_of(static_cast<std::uint32_t>(files.size())) + name;
    files += "PK\x03\x04" + about + name + content;
  }
  const auto count = static_cast<unsigned>(entries.size());
  return files + directory + "PK\x05\x06" + words({0, 0, count, count}) +
         bytes_of(static_cast<std::uint32_t>(directory.size())) +
         bytes_of(static_cast<std::uint32_t>(files.size())) + words({0});
}

std::string xlsx(const WrittenSheet& sheet, const std::string& second_column) {
  const std::string start = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>",
                    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main",
                    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships",
                    package = "http://schemas.openxmlformats.org/package/2006/";
  std::string rows, strings;
  int count_of_strings = 0;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    rows += fmt::format("<row r=\"{}\">", row + 1);
    for (std::size_t column = 0; column < sheet.rows[row].size(); ++column) {
      const SheetCell& cell = sheet.rows[row][column];
      const std::string at = fmt::format("r=\"{}{}\"", static_cast<char>('A' + column), row + 1);
      if (cell.kind == SheetCell::Kind::number) rows += fmt::format("<c {}><v>{}</v></c>", at, cell.value);
      if (cell.kind != SheetCell::Kind::text) continue;
      rows += fmt::format("<c {} t=\"s\"><v>{}</v></c>", at, count_of_strings++);
      strings += "<si>" + (column == 1 ? second_column : "<t>" + cell.text + "</t>") + "</si>";
    }
    rows += "</row>";
  }
  const auto type = [&](const std::string& part, const std::string& what) {
    return fmt::format(
        "<Override PartName=\"/xl/{}\" "
        "ContentType=\"application/vnd.openxmlformats-officedocument.spreadsheetml.{}+xml\"/>",
        part, what);
  };
  const auto relation = [&](int id, const std::string& what, const std::string& target) {
    return fmt::format("<Relationship Id=\"rId{}\" Type=\"{}/{}\" Target=\"{}\"/>", id, office, what, target);
  };
  const std::string relations = start + "<Relationships xmlns=\"" + package + "relationships\">";
  return zip_of(
      {{"[Content_Types].xml", start + "<Types xmlns=\"" + package + "content-types\">" +
                                   type("workbook.xml", "sheet.main") +
                                   type("worksheets/sheet1.xml", "worksheet") +
                                   type("sharedStrings.xml", "sharedStrings") + "</Types>"},
       {"_rels/.rels", relations + relation(1, "officeDocument", "xl/workbook.xml") + "</Relationships>"},
       {"xl/workbook.xml",
        start + "<workbook xmlns=\"" + main + "\" xmlns:r=\"" + office +
            "\"><sheets><sheet name=\"Data\" sheetId=\"1\" r:id=\"rId1\"/></sheets></workbook>"},
       {"xl/_rels/workbook.xml.rels", relations + relation(1, "worksheet", "worksheets/sheet1.xml") +
                                          relation(2, "sharedStrings", "sharedStrings.xml") +
                                          "</Relationships>"},
       {"xl/worksheets/sheet1.xml",
        start + "<worksheet xmlns=\"" + main + "\"><sheetData>" + rows + "</sheetData></worksheet>"},
       {"xl/sharedStrings.xml", fmt::format("{}<sst xmlns=\"{}\" count=\"{}\" uniqueCount=\"{}\">{}</sst>",
                                            start, main, count_of_strings, count_of_strings, strings)}});
}

std::string ods(const WrittenSheet& sheet, int repeated) {
  std::string rows;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    rows += fmt::format("<table:table-row table:number-rows-repeated=\"{}\">",
                        row + 1 == sheet.rows.size() ? repeated : 1);
    for (const SheetCell& cell : sheet.rows[row])
      rows +=
          cell.kind == SheetCell::Kind::number
              ? fmt::format("<table:table-cell office:value-type=\"float\" office:value=\"{}\"/>", cell.value)
              : fmt::format(
                    "<table:table-cell office:value-type=\"string\"><text:p>{}</text:p>"
                    "</table:table-cell>",
                    cell.text);
    rows += "</table:table-row>";
  }
  const std::string names = "urn:oasis:names:tc:opendocument:xmlns:";
  return zip_of(
      {{"mimetype", type_of_ods},
       {"content.xml", fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?><office:document-content "
                                   "xmlns:office=\"{0}office:1.0\" xmlns:table=\"{0}table:1.0\" "
                                   "xmlns:text=\"{0}text:1.0\"><office:body><office:spreadsheet><table:table "
                                   "table:name=\"Data\">{1}</table:table></office:spreadsheet></office:body>"
                                   "</office:document-content>",
                                   names, rows)}});
}

}  // namespace beamid::experiments
