#include "experiments/results/gnuplot_axes.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/results/gnuplot.hpp"
#include "experiments/results/page/figure_data.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

// What is printed as zero has no sign.
std::string without_sign_of_zero(std::string text) {
  const bool is_zero =
      text.find('0') != std::string::npos && text.find_first_of("123456789") == std::string::npos;
  if (is_zero && (text.front() == '-' || text.front() == '+')) text.erase(0, 1);
  return text;
}

}  // namespace

std::string rounded_text(const Rounded& number) {
  constexpr double large = 1e6, small = 1e-5;
  constexpr int two_digits = 1, most = 12;
  const double size = std::abs(number.value);
  if (std::isnan(size)) return "-";
  if (!(number.uncertainty > 0.0) || !std::isfinite(number.uncertainty))
    return fmt::format("{:.6g}", number.value);
  const int last = static_cast<int>(std::floor(std::log10(number.uncertainty))) - two_digits;
  if (size == 0.0 || (size >= small && size < large))
    return without_sign_of_zero(fmt::format("{:.{}f}", number.value, std::clamp(-last, 0, most)));
  const int digits = static_cast<int>(std::floor(std::log10(size))) - last + 1;
  return fmt::format("{:.{}g}", number.value, std::clamp(digits, 2, most));
}

std::string cell_text(const Column& column, const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* number = std::get_if<Rounded>(&cell)) return rounded_text(*number);
  const double value = std::get<double>(cell);
  if (std::isnan(value)) return "-";
  try {
    return without_sign_of_zero(fmt::format(fmt::runtime(column.format), value));
  } catch (const fmt::format_error& error) {
    throw std::invalid_argument("column '" + column.key + "': format '" + column.format +
                                "': " + error.what());
  }
}

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

/// Whether Hebrew, Arabic or another script from right to left begins here (UTF-8; blocks from U+0590 to
/// U+08FF, U+FB1D to U+FEFF).
bool runs_to_the_left(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  return (byte(0) >= 0xD6 && byte(0) <= 0xDF) || (byte(0) == 0xE0 && byte(1) >= 0xA0 && byte(1) <= 0xA3) ||
         (byte(0) == 0xEF && byte(1) >= 0xAC && byte(1) <= 0xBB && byte(1) != 0xB8);
}

/// The text with a mark (U+200E) behind each passage from right to left: without it a browser takes the
/// numbers that follow for its continuation.
std::string with_direction(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
    result.append(text, at, end - at);
    const std::size_t next = std::min(text.find_first_not_of(' ', end), text.size());
    const std::string_view here = std::string_view(text).substr(at),
                           behind = std::string_view(text).substr(next);
    if (runs_to_the_left(here) && !runs_to_the_left(behind) && !behind.starts_with("\u200e"))
      result += "\u200e";
    at = end;
  }
  return result;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : with_direction(clean_lines(text))) {
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
         escaped(description) + R"(" src=")" + picture_address(content) + "\"></div>\n<figcaption>" +
         typeset_html(caption) + "</figcaption></figure>\n";
}

namespace {

constexpr std::array<std::string_view, 10> raised_digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

bool letter_or_digit(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

bool digit(char c) {
  return c >= '0' && c <= '9';
}

/// "^2", "^-8" at `at`: their length, 0 where there is none.
std::size_t power_at(std::string_view text, std::size_t at) {
  if (text[at] != '^' || at == 0 || !letter_or_digit(text[at - 1])) return 0;
  std::size_t end = at + 1;
  if (end < text.size() && text[end] == '-') ++end;
  const std::size_t first = end;
  while (end < text.size() && digit(text[end])) ++end;
  return end > first ? end - at : 0;
}

/// Whether a unit may begin at `at`: behind "[", "/", "(", a number or another unit with a blank.
bool unit_begins(std::string_view text, std::size_t at) {
  if (at == 0) return false;
  const char before = text[at - 1];
  if (before == '[' || before == '/') return true;
  if (before == '(') return at + 2 < text.size() && text[at] == 'm' && text[at + 1] == '/';
  if (before != ' ' || at < 2) return false;
  if (digit(text[at - 2])) return true;
  constexpr std::array<std::string_view, 5> units{"N", "kg", "m", "s", "g"};
  return std::any_of(units.begin(), units.end(), [&](std::string_view unit) {
    return text.substr(0, at - 1).ends_with(unit) &&
           (at - 1 == unit.size() || !letter_or_digit(text[at - 2 - unit.size()]));
  });
}

/// "m2", "s2", "m4" of a unit at `at`: the length of its letters, 0 where there is none.
std::size_t raised_unit_at(std::string_view text, std::size_t at) {
  if (!unit_begins(text, at)) return 0;
  for (const std::string_view unit : {"mm", "m", "s"}) {
    const std::size_t end = at + unit.size();
    if (text.substr(at).starts_with(unit) && end < text.size() && text[end] >= '2' && text[end] <= '4' &&
        (end + 1 == text.size() || !letter_or_digit(text[end + 1])))
      return unit.size();
  }
  return 0;
}

}  // namespace

std::string typeset(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i).starts_with(" +- ")) {  // with blanks where no line breaks
      result += "\u00a0±\u00a0";
      i += 4;
    } else if (text.substr(i).starts_with("+-")) {
      result += "±";
      i += 2;
    } else if (text.substr(i).starts_with("chi^2") && (i == 0 || !letter_or_digit(text[i - 1]))) {
      result += "χ²";
      i += 5;
    } else if (const std::size_t power = power_at(text, i); power > 0) {
      for (const char c : text.substr(i + 1, power - 1)) result += c == '-' ? "⁻" : raised_digits[c - '0'];
      i += power;
    } else if (const std::size_t unit = raised_unit_at(text, i); unit > 0) {
      result.append(text.substr(i, unit)).append(raised_digits[text[i + unit] - '0']);
      i += unit + 1;
    } else {
      result += text[i++];
    }
  }
  return result;
}

namespace {

bool has_points(const Panel& panel) {
  return std::any_of(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) {
    return curve.style == CurveStyle::points || curve.style == CurveStyle::open_points ||
           curve.style == CurveStyle::intervals;
  });
}

// A legend's height inside the frame as a part of what the curves take; below zero at the bottom.
double legend_room(const Panel& panel) {
  const auto labels = std::count_if(panel.curves.begin(), panel.curves.end(),
                                    [](const Curve& curve) { return !curve.label.empty(); });
  const double height = std::min(0.06 + 0.09 * static_cast<double>(labels), 0.5);
  switch (panel.legend) {
    case Legend::top_left:
    case Legend::top_right:
      return height / (1 - height);
    case Legend::bottom_left:
    case Legend::bottom_right:
      return -height / (1 - height);
    default:
      return 0;
  }
}

AxisRange logarithmic_range(const Extent& extent, double room) {
  const double decades = std::log10(extent.high / extent.low), margin = std::max(0.06 * decades, 0.02);
  return {extent.low * std::pow(10.0, -margin + std::min(room, 0.0) * decades),
          extent.high * std::pow(10.0, margin + std::max(room, 0.0) * decades)};
}

// A record of 0 to 24.999 s ends at 25, so that its last tick is shown.
AxisRange linear_range(const Extent& extent, bool points) {
  const double span = extent.high - extent.low;
  if (points) return {extent.low - 0.05 * span, extent.high + 0.05 * span};
  const double step = rounded_up_step(span / 100), low = std::floor(extent.low / step) * step,
               high = std::ceil(extent.high / step) * step;
  return {extent.low - low <= 0.005 * span ? low : extent.low,
          high - extent.high <= 0.005 * span ? high : extent.high};
}

// A vertical axis ends on ticks.
AxisRange upright_range(const Extent& extent, bool points, double room, double length) {
  double span = extent.high - extent.low;
  if (!(span > 1e-12 * std::max(std::abs(extent.low), std::abs(extent.high))))
    span = extent.high != 0 ? 0.2 * std::abs(extent.high) : 2;
  double low = extent.low, high = extent.high;
  if (span > extent.high - extent.low) low -= 0.5 * span, high += 0.5 * span;
  if (points) low -= 0.03 * span, high += 0.03 * span;
  high += std::max(room, 0.0) * span, low += std::min(room, 0.0) * span;
  const double step = step_for({low, high}, length, true);
  return {std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step};
}

DrawnAxis drawn_axis(char name, const Axis& axis, const AxisRange& range, double length) {
  const bool named = !axis.names.empty();
  const Ticks ticks =
      named ? named_ticks(std::string(1, name), axis.names)
      : axis.logarithmic
          ? logarithmic_ticks(name, range, length)
          : linear_ticks(name, range, axis.tick > 0 ? axis.tick : step_for(range, length, name == 'y'));
  return {fmt::format("  set {0}label {1}\n  set {0}range [{2}:{3}]\n{4}", name,
                      gnuplot_text(typeset(axis.label)), range.first, range.second,
                      axis.logarithmic && !named ? fmt::format("  set logscale {}\n", name) : "") +
              ticks.commands,
          ticks.widest, range};
}

AxisRange named_range(const Axis& axis, bool upright) {
  const double first = 0.4, last = static_cast<double>(axis.names.size()) + 0.6;
  return upright ? AxisRange{last, first} : AxisRange{first, last};
}

AxisRange empty_range(const Axis& axis) {
  return {axis.logarithmic ? 0.1 : 0.0, 1.0};
}

}  // namespace

Extent::Extent() : low(std::numeric_limits<double>::infinity()), high(-low) {}

void Extent::add(const Eigen::VectorXd& values, bool positive) {
  for (const double value : values) {
    if (!std::isfinite(value) || (positive && value <= 0)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
}

DrawnAxis drawn_x_axis(const Panel& panel, double length) {
  const Axis& axis = panel.x_axis;
  if (!axis.names.empty()) return drawn_axis('x', axis, named_range(axis, false), length);
  Extent extent;
  for (const Curve& curve : panel.curves) {
    extent.add(curve.x, axis.logarithmic);
    if (along_x(curve)) extent.add(curve.lower, axis.logarithmic), extent.add(curve.upper, axis.logarithmic);
  }
  std::optional<AxisRange> range = axis.range;
  if (!range && extent.empty()) range = empty_range(axis);
  if (!range && axis.logarithmic) range = logarithmic_range(extent, 0);
  if (!range && extent.low < extent.high) range = linear_range(extent, has_points(panel));
  if (!range) range = upright_range(extent, true, 0, length);
  return drawn_axis('x', axis, *range, length);
}

DrawnAxis drawn_y_axis(const Panel& panel, double length) {
  const Axis& axis = panel.y_axis;
  if (!axis.names.empty()) return drawn_axis('y', axis, named_range(axis, true), length);
  Extent extent;
  for (const Curve& curve : panel.curves) {
    extent.add(curve.y, axis.logarithmic);
    if (curve.style == CurveStyle::stems) extent.add(Eigen::VectorXd::Zero(1), axis.logarithmic);
    if (!along_x(curve)) extent.add(curve.lower, axis.logarithmic), extent.add(curve.upper, axis.logarithmic);
  }
  std::optional<AxisRange> range = axis.range;
  if (!range && extent.empty()) range = empty_range(axis);
  if (!range && axis.logarithmic) range = logarithmic_range(extent, legend_room(panel));
  if (!range) range = upright_range(extent, has_points(panel), legend_room(panel), length);
  return drawn_axis('y', axis, *range, length);
}

}  // namespace beamid::experiments
