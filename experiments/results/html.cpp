#include "experiments/results/html.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "experiments/results/cell_text.hpp"
#include "experiments/text/clean_text.hpp"

namespace beamid::experiments {
namespace {

constexpr std::array<std::pair<char, std::string_view>, 4> entities{
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}}};

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

std::string html_table(const Table& table) {
  std::string html = "<figure class=\"table\">\n";
  if (!table.title.empty()) html += "<figcaption>" + escaped(table.title) + "</figcaption>\n";
  html += "<table>\n<tr>";
  for (const Column& column : table.columns) html += "<th>" + escaped(column.heading) + "</th>";
  html += "</tr>\n";
  for (std::size_t i = 0; i < table.rows(); ++i) {
    html += "<tr>";
    for (const Column& column : table.columns) {
      const bool number = std::holds_alternative<double>(column.cells[i]);
      html +=
          (number ? "<td class=\"number\">" : "<td>") + escaped(cell_text(column, column.cells[i])) + "</td>";
    }
    html += "</tr>\n";
  }
  html += "</table>\n";
  if (!table.note.empty()) html += "<p class=\"note\">" + escaped(table.note) + "</p>\n";
  return html + "</figure>\n";
}

std::string html_picture(const std::filesystem::path& svg, std::string_view description) {
  std::ifstream file(svg, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || content.empty()) throw std::runtime_error(svg.string() + " cannot be read");
  return "<figure><img alt=\"" + escaped(description) + "\" src=\"data:image/svg+xml;base64," +
         base64(content) + "\"></figure>\n";
}

}  // namespace beamid::experiments
