#include "experiments/results/html.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include "experiments/results/cell_text.hpp"
#include "experiments/results/typeset.hpp"
#include "experiments/text/clean_text.hpp"

namespace beamid::experiments {
namespace {

constexpr std::array<std::pair<char, std::string_view>, 4> entities{
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}}};

/// Decimals of a column's cells, -1 where a cell is no number.
struct NumberColumn {
  bool numbers = false;
  std::vector<int> decimals;
  int most = 0;
};

/// "-12.30": 2; "7": 0; texts, and numbers with an exponent: -1.
int cell_decimals(const std::string& text) {
  const std::size_t first = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const std::size_t point = text.find('.', first);
  const auto digits = [](std::string_view part) {
    return !part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (point == std::string::npos) return digits(std::string_view(text).substr(first)) ? 0 : -1;
  const std::string_view whole = std::string_view(text).substr(first, point - first),
                         part = std::string_view(text).substr(point + 1);
  return digits(whole) && digits(part) ? static_cast<int>(part.size()) : -1;
}

NumberColumn number_column(const Column& column) {
  NumberColumn found;
  bool numbers = true, any = false;
  for (const Cell& cell : column.cells) {
    const std::string text = cell_text(column, cell);
    const int decimals = cell_decimals(text);
    found.decimals.push_back(decimals);
    found.most = std::max(found.most, decimals);
    const bool blank = text.empty() || text == "-" || text == "nan";
    any = any || decimals >= 0 || std::holds_alternative<double>(cell);
    numbers = numbers && (decimals >= 0 || blank || std::holds_alternative<double>(cell));
  }
  found.numbers = numbers && any;
  return found;
}

/// As wide as the decimals that the cell lacks: figure spaces, and a punctuation space for the point.
std::string decimal_padding(const NumberColumn& column, std::size_t row) {
  const int decimals = column.decimals[row];
  if (decimals < 0 || decimals == column.most) return "";
  std::string spaces = decimals == 0 ? "\u2008" : "";
  for (int i = decimals; i < column.most; ++i) spaces += "\u2007";
  return "<span class=\"pad\">" + spaces + "</span>";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : clean_lines(text)) {
    const auto* const special =
        std::find_if(entities.begin(), entities.end(), [&](const auto& e) { return e.first == letter; });
    if (special != entities.end())
      result += special->second;
    else
      result += letter;
  }
  return result;
}

std::string unescaped(std::string_view html) {
  std::string result;
  while (!html.empty()) {
    const auto* const special = std::find_if(entities.begin(), entities.end(),
                                             [&](const auto& e) { return html.starts_with(e.second); });
    result += special != entities.end() ? special->first : html.front();
    html.remove_prefix(special != entities.end() ? special->second.size() : 1);
  }
  return result;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      result += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return result;
}

std::string typeset_html(std::string_view text) {
  return escaped(typeset(text));
}

std::string html_table(const Table& table) {
  const std::size_t rows = table.rows();
  std::vector<NumberColumn> columns;
  for (const Column& column : table.columns) columns.push_back(number_column(column));
  std::string html = "<figure class=\"table\">\n";
  if (!table.title.empty()) html += "<figcaption>" + typeset_html(table.title) + "</figcaption>\n";
  html += "<div class=\"scroll\">\n<table>\n<thead><tr>";
  for (std::size_t j = 0; j < columns.size(); ++j)
    html += (columns[j].numbers ? "<th class=\"number\">" : "<th>") + typeset_html(table.columns[j].heading) +
            "</th>";
  html += "</tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < rows; ++i) {
    html += "<tr>";
    for (std::size_t j = 0; j < columns.size(); ++j)
      html += (columns[j].numbers ? "<td class=\"number\">" : "<td>") +
              typeset_html(cell_text(table.columns[j], table.columns[j].cells[i])) +
              (columns[j].numbers ? decimal_padding(columns[j], i) : "") + "</td>";
    html += "</tr>\n";
  }
  html += "</tbody>\n</table>\n</div>\n";
  if (!table.note.empty()) html += "<p class=\"note\">" + typeset_html(table.note) + "</p>\n";
  return html + "</figure>\n";
}

std::string html_picture(const std::filesystem::path& svg, std::string_view description,
                         std::string_view caption, std::string_view attributes) {
  std::ifstream file(svg, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || content.empty()) throw std::runtime_error(svg.string() + " cannot be read");
  return "<figure class=\"plot\"" + std::string(attributes) + R"(><div class="scroll"><img alt=")" +
         escaped(description) + R"(" src="data:image/svg+xml;base64,)" + base64(content) +
         "\"></div>\n<figcaption>" + typeset_html(caption) + "</figcaption></figure>\n";
}

}  // namespace beamid::experiments
