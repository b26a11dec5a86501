// Rows of plain numbers, many at a time: what a long file nearly always is, read on all cores; rows that are
// one series, several numbers to a line; and rows below a time and a rate.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Core>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

struct PlainForm {
  std::size_t width;
  char separator, decimal;

  bool is_blank(char letter) const { return letter == ' ' || (letter == '\t' && separator != '\t'); }
};

/// Whole lines of a text, one after the other.
class PlainBlock {
 public:
  PlainBlock(std::string_view text, const PlainForm& form)
      : text_(text),
        form_(form),
        lines_(static_cast<std::size_t>(std::ranges::count(text, '\n'))),
        precision_(form.width) {}

  std::size_t lines() const { return lines_; }
  std::size_t rows() const { return rows_; }
  bool is_plain() const { return rows_ == lines_; }  ///< throughout
  std::size_t end() const { return end_; }           ///< characters of its rows
  const std::vector<std::string_view>& marks() const { return marks_; }
  const std::vector<PrintedPrecision>& precision() const { return precision_; }

  /// Reads up to the first row that is not plain. @param first row of the columns, which hold lines() from
  /// there on
  void read(std::vector<std::vector<double>>& columns, std::size_t first) {
    at_ = text_.data();
    for (; rows_ < lines_; ++rows_) {
      const char* const begin = at_;
      if (!read_row(columns, first + rows_)) return;
      if (rows_ % TextCells::most_rows == 0) marks_.emplace_back(begin, 1);
      end_ = static_cast<std::size_t>(at_ - text_.data());
    }
  }

 private:
  const char* text_end() const { return text_.data() + text_.size(); }

  void pass_blanks() {
    while (form_.is_blank(*at_)) ++at_;  // up to the end of a line at most
  }

  bool read_row(std::vector<std::vector<double>>& columns, std::size_t row) {
    for (std::size_t column = 0; column < form_.width; ++column) {
      pass_blanks();
      if (!read_cell(columns[column][row], precision_[column])) return false;
      const char* const cell_end = at_;
      pass_blanks();
      if (column + 1 == form_.width) break;
      if (form_.separator == ' ' ? cell_end == at_ : *at_++ != form_.separator) return false;
    }
    while (form_.separator != ' ' && *at_ == form_.separator) ++at_, pass_blanks();
    if (*at_ == '\r') ++at_;
    return *at_++ == '\n';
  }

  bool read_cell(double& value, PrintedPrecision& precision) {
    const char* begin = at_;
    if (*at_ == '+' && at_[1] != '-') ++at_;
    std::from_chars_result read{};
    if (form_.decimal == '.') {
      read = std::from_chars(at_, text_end(), value);
      at_ = read.ptr;
    } else {
      constexpr std::size_t longest = 64;
      char pointed[longest];
      std::size_t size = 0;
      for (; size < longest && is_of_number(*at_); ++at_, ++size) pointed[size] = *at_ == ',' ? '.' : *at_;
      if (size == longest) return false;
      read = std::from_chars(pointed, pointed + size, value);
      if (read.ptr != pointed + size) return false;
      if (read.ec == std::errc()) precision.add({pointed, size});
      return read.ec == std::errc();
    }
    if (read.ec != std::errc()) return false;
    if (std::isfinite(value))
      precision.add({begin, static_cast<std::size_t>(at_ - begin)});
    else
      value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }

  static bool is_of_number(char letter) {
    return (letter >= '0' && letter <= '9') || letter == ',' || letter == '-' || letter == '+' ||
           letter == 'e' || letter == 'E';
  }

  std::string_view text_;
  PlainForm form_;
  std::size_t lines_, rows_ = 0, end_ = 0;
  const char* at_ = nullptr;
  std::vector<PrintedPrecision> precision_;
  std::vector<std::string_view> marks_;  ///< every sixteenth row
};

/// A text in blocks of `size` characters at most, but for a last line without its end.
std::vector<PlainBlock> blocks_of(std::string_view text, std::size_t size, const PlainForm& form) {
  std::vector<PlainBlock> blocks;
  for (std::size_t end; (end = text.substr(0, size).rfind('\n')) != text.npos; text.remove_prefix(end + 1))
    blocks.emplace_back(text.substr(0, end + 1), form);
  return blocks;
}

}  // namespace

std::size_t DelimitedText::take_plain_stretch(RecordTable& table, TextCells& cells, std::size_t length) {
  constexpr std::size_t block_size = 1 << 20;
  std::vector<PlainBlock> blocks =
      blocks_of(rest_.substr(0, length), block_size, {width_, separator_, decimal_});
  std::vector<std::size_t> first{table.rows()};  // of each block
  for (const PlainBlock& block : blocks) first.push_back(first.back() + block.lines());
  for (std::vector<double>& column : table.columns) column.resize(first.back());
  tbb::parallel_for(std::size_t{0}, blocks.size(),
                    [&](std::size_t k) { blocks[k].read(table.columns, first[k]); });
  std::size_t read = 0;
  bool is_plain = true;
  for (std::size_t k = 0; k < blocks.size() && is_plain; ++k) {
    const PlainBlock& block = blocks[k];
    for (std::size_t row = 0; row < block.rows(); row += TextCells::most_rows)
      cells.add(block.marks()[row / TextCells::most_rows], line_number_ + 1 + row,
                std::min(TextCells::most_rows, block.rows() - row));
    for (std::size_t column = 0; column < width_; ++column)
      table.precision[column].add(block.precision()[column]);
    table.lines.add(line_number_ + 1, block.rows());
    line_number_ += block.rows(), read += block.rows();
    rest_.remove_prefix(block.end());
    is_plain = block.is_plain();
  }
  for (std::vector<double>& column : table.columns) column.resize(first.front() + read);
  return read;
}

void DelimitedText::take_plain_rows(RecordTable& table, TextCells& cells) {
  constexpr std::size_t least = 1 << 16, most = 1 << 28, growth = 8, few = 100;
  constexpr std::ptrdiff_t longest_pause = 4096;
  const bool header_is_a_row = header_text_.find_first_of("0123456789") == 0;  // it may be repeated
  if (labelled_ || header_is_a_row || pause_-- > 0) return;
  std::size_t all = 0, length = least;
  for (std::size_t read; (read = take_plain_stretch(table, cells, length)) > 0; all += read)
    length = std::min(most, growth * length);
  next_pause_ = all < few ? std::min(longest_pause, 2 * next_pause_ + 1) : 0;
  pause_ = next_pause_;
}

namespace {

/// Rows of a table as columns (width x rows): its numbers in the order of the text.
Eigen::MatrixXd series_of(const RecordTable& table) {
  Eigen::MatrixXd series(static_cast<Eigen::Index>(table.width()), static_cast<Eigen::Index>(table.rows()));
  for (std::size_t k = 0; k < table.width(); ++k)
    series.row(static_cast<Eigen::Index>(k)) =
        Eigen::Map<const Eigen::RowVectorXd>(table.columns[k].data(), series.cols());
  return series;
}

/// Rows without names or times that go on from one to the next: one series, written several numbers to a
/// line. The text above them states how many points there are, or the step from a row's last number to the
/// next row's first is that within the rows, and smaller than that down a column. Columns of a series are of
/// one mean and one size.
bool go_on(const RecordTable& table, std::string_view above, std::size_t last) {
  constexpr std::size_t fewest_columns = 3, fewest_rows = 20;
  constexpr double alike = 0.25, less = 0.6, one_mean = 0.25, one_size = 0.2, smooth = 0.9;
  if (!table.names.empty() || table.time || table.width() < fewest_columns || table.rows() < fewest_rows)
    return false;
  if (std::ranges::any_of(table.columns, rises)) return false;
  const Eigen::MatrixXd series = series_of(table);
  if (!series.allFinite()) return false;
  static const std::regex of_all("channel|kan(a|\xc3\xa4)l|canal|total", std::regex::icase);
  const std::string numbers = std::to_string(table.rows() * table.width() + last);
  const std::regex count("(^|[^0-9.])" + numbers + "($|[^0-9.])"),
      points("(points?|npts)[^0-9\n]{1,8}" + numbers + "($|[^0-9.])|(^|[^0-9.])" + numbers + " +points",
             std::regex::icase);
  const auto states = [&](const std::regex& one) {
    return std::regex_search(above.begin(), above.end(), one) &&
           !std::regex_search(above.begin(), above.end(), of_all);
  };
  if (states(points)) return true;
  const Eigen::Index width = series.rows(), rows = series.cols();
  const double mean = series.mean(), size = std::sqrt((series.array() - mean).square().mean());
  const Eigen::VectorXd means = series.rowwise().mean(),
                        sizes = (series.colwise() - means).cwiseAbs2().rowwise().mean().cwiseSqrt();
  if (!((means.array() - mean).abs() <= one_mean * size).all() ||
      !((sizes.array() - size).abs() <= one_size * size).all())
    return false;
  const double within = (series.bottomRows(width - 1) - series.topRows(width - 1)).cwiseAbs().mean(),
               down = (series.rightCols(rows - 1) - series.leftCols(rows - 1)).cwiseAbs().mean(),
               over = (series.row(0).tail(rows - 1) - series.row(width - 1).head(rows - 1)).cwiseAbs().mean();
  if (!(within > 0.0) || std::abs(over / within - 1.0) > alike || within > smooth * size) return false;
  return within < less * down || states(count);
}

void join_rows(RecordTable& table, const std::vector<double>& last) {
  const Eigen::MatrixXd series = series_of(table);
  std::vector<double> all(series.data(), series.data() + series.size());
  all.insert(all.end(), last.begin(), last.end());
  table.remarks.push_back(
      fmt::format("Each row of {} numbers goes on from the row before: one series of {} numbers.",
                  table.width(), all.size()));
  table.columns.assign(1, std::move(all));
  table.precision.resize(1);
  table.lines.clear(), table.skipped_lines.clear();
  table.cell = nullptr;
}

}  // namespace

void join_rows_that_go_on(RecordTable& table, std::string_view above, const std::vector<double>& last) {
  if (go_on(table, above, last.size())) join_rows(table, last);
}

void take_start_and_rate(RecordTable& table) {
  constexpr double oldest = 1e9, newest = 4e9, fastest = 1e5;
  constexpr std::size_t fewest = 16;
  if (!table.names.empty() || table.time || table.rows() < fewest) return;
  const double start = table.columns[0][0], rate = table.columns[0][1];
  if (!(start > oldest && start < newest && rate > 0.0 && rate < fastest)) return;
  for (const std::vector<double>& values : table.columns)
    if (values[0] != start || values[1] != rate || std::abs(values[2]) > fastest) return;
  std::vector<bool> kept(table.rows(), true);
  kept[0] = kept[1] = false;
  table.keep(kept);
  table.stated_rate = rate;
  table.remarks.emplace_back("The first row is the time of the first sample, the second the rate.");
}

}  // namespace beamid::experiments
