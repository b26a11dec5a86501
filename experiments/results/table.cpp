#include "experiments/results/table.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {

const double* number_of(const Cell& cell) {
  if (const auto* rounded = std::get_if<Rounded>(&cell)) return &rounded->value;
  return std::get_if<double>(&cell);
}

Table& Table::column(Column column) {
  columns.push_back(std::move(column));
  return *this;
}

Table& Table::row(std::vector<Cell> cells) {
  if (cells.size() != columns.size())
    throw std::invalid_argument(
        fmt::format("table '{}': row of {} cells; expected {}", name, cells.size(), columns.size()));
  for (std::size_t i = 0; i < cells.size(); ++i) columns[i].cells.push_back(std::move(cells[i]));
  return *this;
}

std::size_t Table::rows() const {
  if (columns.empty()) return 0;
  const std::size_t count = columns.front().cells.size();
  for (const Column& column : columns)
    if (column.cells.size() != count)
      throw std::invalid_argument(fmt::format("table '{}': column '{}' has {} cells; expected {}", name,
                                              column.key, column.cells.size(), count));
  return count;
}

std::string to_csv(const Table& table) {
  const std::size_t rows = table.rows();
  std::string csv;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) csv += ',';
    csv += csv_field(table.columns[i].key);
  }
  csv += '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (i > 0) csv += ',';
      const Cell& cell = table.columns[i].cells[row];
      const double* number = number_of(cell);
      csv += number ? csv_field(*number) : csv_field(std::get<std::string>(cell));
    }
    csv += '\n';
  }
  return csv;
}

namespace {

using Lines = std::vector<std::string>;
constexpr std::size_t column_gap = 2;        // between columns
constexpr std::size_t narrowest_texts = 20;  // a column of texts is not broken to less

std::size_t column_width_of(const Lines& lines) {
  std::size_t width = 0;
  for (const std::string& line : lines) width = std::max(width, experiments::width_of(line));
  return width;
}

struct Strip {
  std::string title;
  bool right = false;
  Lines heading;             // lines of the wrapped title
  std::vector<Lines> cells;  // lines of each row
  std::size_t width = 0;

  // A unit stays in one piece: its blanks are no place to break.
  void wrap_heading(std::size_t limit) {
    std::string bound = title;
    bool inside = false;
    for (char& c : bound) {
      inside = c == '[' || (inside && c != ']');
      if (inside && c == ' ') c = '\1';
    }
    heading = wrapped(bound, limit);
    for (std::string& line : heading) std::replace(line.begin(), line.end(), '\1', ' ');
    width = column_width_of(heading);
    for (const Lines& cell : cells) width = std::max(width, column_width_of(cell));
  }
};

Strip strip_of(const Column& column) {
  Strip strip{column.heading, false, {column.heading}, {}, experiments::width_of(column.heading)};
  for (const Cell& cell : column.cells) {
    strip.right |= std::holds_alternative<double>(cell);
    strip.cells.push_back({cell_text(column, cell)});
    strip.width = std::max(strip.width, column_width_of(strip.cells.back()));
  }
  return strip;
}

std::size_t total(const std::vector<Strip>& strips) {
  return std::accumulate(strips.begin(), strips.end(), std::size_t{0},
                         [](std::size_t sum, const Strip& s) { return sum + s.width + column_gap; }) -
         column_gap;
}

// Widens broken headings again as far as there is room, the tallest first.
void relax_headings(std::vector<Strip>& strips, std::size_t page) {
  for (bool changed = true; changed;) {
    changed = false;
    Strip& tallest = *std::max_element(strips.begin(), strips.end(), [](const Strip& a, const Strip& b) {
      return a.heading.size() < b.heading.size();
    });
    for (std::size_t width = tallest.width; width <= page && tallest.heading.size() > 1; ++width) {
      Strip wider = tallest;
      wider.wrap_heading(width);
      if (wider.heading.size() == tallest.heading.size()) continue;
      if (total(strips) - tallest.width + wider.width <= page) {
        tallest = wider;
        changed = true;
      }
      break;
    }
  }
}

// Breaks columns of texts, the widest first, if that makes the table fit.
void break_texts(std::vector<Strip>& strips, std::size_t page) {
  std::vector<Strip> narrower = strips;
  while (total(narrower) > page) {
    Strip* widest = nullptr;
    for (Strip& strip : narrower)
      if (!strip.right && (widest == nullptr || strip.width > widest->width)) widest = &strip;
    if (widest == nullptr || widest->width <= narrowest_texts) return;
    --widest->width;
  }
  for (std::size_t i = 0; i < strips.size(); ++i) {
    if (narrower[i].width == strips[i].width) continue;
    for (Lines& cell : strips[i].cells) cell = wrapped(cell.front(), narrower[i].width);
    strips[i].wrap_heading(narrower[i].width);
  }
}

// Whether the first columns alone tell every two rows apart.
bool rows_differ(const std::vector<Strip>& strips, std::size_t columns) {
  std::set<std::vector<Lines>> seen;
  for (std::size_t row = 0; row < strips[0].cells.size(); ++row) {
    std::vector<Lines> key;
    for (std::size_t i = 0; i < columns; ++i) key.push_back(strips[i].cells[row]);
    if (!seen.insert(key).second) return false;
  }
  return true;
}

// How many columns are repeated below: the first, as few as tell the rows apart. Where none do within two
// thirds of the page, the texts before the first number.
std::size_t key_columns(const std::vector<Strip>& strips, std::size_t page) {
  std::size_t width = 0, texts = 0;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    width += strips[i].width + column_gap;
    if (width > page * 2 / 3) break;
    if (strips[i].cells.size() > 1 && rows_differ(strips, i + 1)) return i + 1;
    if (texts == i && !strips[i].right && width <= page / 2) texts = i + 1;
  }
  return texts;
}

// Blocks of columns that fit the page, each after the first with the columns repeated that say which row it
// is.
std::vector<std::vector<Strip>> folded(const std::vector<Strip>& strips, std::size_t page) {
  if (total(strips) <= page) return {strips};
  const auto keys = static_cast<std::ptrdiff_t>(key_columns(strips, page));
  const std::vector<Strip> leading(strips.begin(), strips.begin() + keys);
  std::vector<std::vector<Strip>> blocks{leading};
  for (std::size_t i = leading.size(); i < strips.size(); ++i) {
    if (blocks.back().size() > leading.size() && total(blocks.back()) + column_gap + strips[i].width > page)
      blocks.push_back(leading);
    blocks.back().push_back(strips[i]);
  }
  return blocks;
}

void print_line(std::ostream& stream, const std::vector<Strip>& strips,
                const std::vector<const Lines*>& cells, bool bottom) {
  std::size_t height = 0;
  for (const Lines* cell : cells) height = std::max(height, cell->size());
  for (std::size_t line = 0; line < height; ++line) {
    std::string out;
    for (std::size_t i = 0; i < strips.size(); ++i) {
      const std::size_t skip = bottom ? height - cells[i]->size() : 0;
      const std::string text = line >= skip && line - skip < cells[i]->size() ? (*cells[i])[line - skip] : "";
      const std::string blanks(strips[i].width - experiments::width_of(text), ' ');
      out += std::string(i == 0 ? 0 : column_gap, ' ') + (strips[i].right ? blanks + text : text + blanks);
    }
    stream << out.substr(0, out.find_last_not_of(' ') + 1) << '\n';
  }
}

void print_block(std::ostream& stream, const std::vector<Strip>& strips, std::size_t rows) {
  std::vector<const Lines*> cells;
  for (const Strip& strip : strips) cells.push_back(&strip.heading);
  print_line(stream, strips, cells, true);
  for (std::size_t i = 0; i < strips.size(); ++i)
    stream << std::string(i == 0 ? 0 : column_gap, ' ') << std::string(strips[i].width, '-');
  stream << '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < strips.size(); ++i) cells[i] = &strips[i].cells[row];
    print_line(stream, strips, cells, false);
  }
}

}  // namespace

void print(std::ostream& stream, const Table& table) {
  print(stream, table, Page());
}

void print(std::ostream& stream, const Table& table, const Page& paper) {
  const std::size_t page = paper.width;
  const std::size_t rows = table.rows();
  for (const std::string& line : wrapped(table.title, page)) stream << line << '\n';
  std::vector<Strip> strips;
  for (const Column& column : table.columns) strips.push_back(strip_of(column));
  if (!strips.empty()) {
    if (total(strips) > page)
      for (Strip& strip : strips) strip.wrap_heading(1);
    if (total(strips) > page) break_texts(strips, page);
    std::vector<std::vector<Strip>> blocks = folded(strips, page);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (i > 0) stream << '\n';
      if (total(blocks[i]) > page) break_texts(blocks[i], page);
      relax_headings(blocks[i], page);
      print_block(stream, blocks[i], rows);
    }
  }
  for (const std::string& line : wrapped(table.note, page)) stream << line << '\n';
}

}  // namespace beamid::experiments
