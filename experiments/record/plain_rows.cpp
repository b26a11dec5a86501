// Rows of plain numbers, many at a time: what a long file nearly always is, read on all cores.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/record_table.hpp"
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

}  // namespace beamid::experiments
