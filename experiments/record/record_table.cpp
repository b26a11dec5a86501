#include "experiments/record/record_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <regex>
#include <utility>

#include <fmt/format.h>

#include "experiments/record/stamps.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr const char* too_coarse =
    " (times printed this coarsely need the sampling rate: --rate HZ, or record.sampling_rate_hz)";

}  // namespace

void PrintedPrecision::add(std::string_view token) {
  int decimals = 0, digits = 0, exponent = 0;
  bool point = false;
  for (std::size_t i = 0; i < token.size(); ++i) {
    if (token[i] == '.') {
      point = true;
    } else if (std::string_view("eEdD").find(token[i]) != std::string_view::npos) {
      const std::size_t start = i + (token.substr(i + 1).starts_with('+') ? 2 : 1);
      std::from_chars(token.data() + start, token.data() + token.size(), exponent);
      break;
    } else if (token[i] >= '0' && token[i] <= '9') {
      decimals += point ? 1 : 0;
      digits += digits > 0 || token[i] != '0' ? 1 : 0;
    }
  }
  decimals_ = std::max(decimals_, decimals - exponent);
  digits_ = std::max(digits_, digits);
}

void PrintedPrecision::add(const PrintedPrecision& other) {
  decimals_ = std::max(decimals_, other.decimals_);
  digits_ = std::max(digits_, other.digits_);
}

PrintedPrecision PrintedPrecision::of_digits(int digits) {
  PrintedPrecision precision;
  precision.decimals_ = 400;
  precision.digits_ = digits;
  return precision;
}

double PrintedPrecision::resolution(double value) const {
  const double fixed = std::pow(10.0, -decimals_);
  if (value == 0) return fixed;
  return std::max(fixed, std::pow(10.0, std::floor(std::log10(std::abs(value))) + 1 - digits_));
}

std::optional<SamplingFault> find_order_fault(const std::vector<double>& times) {
  const auto later = [&](std::size_t i) { return times[i] > times[i - 1]; };
  std::size_t i = 1;
  while (i < times.size() && later(i)) ++i;
  if (i >= times.size()) return std::nullopt;
  constexpr std::size_t many = 8;
  std::size_t equal = 0;
  for (std::size_t j = 1; j < times.size(); ++j) equal += times[j] == times[j - 1] ? 1 : 0;
  const bool coarse =
      2 * equal > times.size() ||
      (equal > many && 8 * equal > times.size());  // the seconds of a clock, printed without their decimals
  return SamplingFault{i, fmt::format("time {} after {}; expected increasing times{}", times[i], times[i - 1],
                                      coarse ? too_coarse : "")};
}

std::optional<SamplingFault> find_sampling_fault(const std::vector<double>& times,
                                                 const PrintedPrecision& precision) {
  if (auto fault = find_order_fault(times)) return fault;
  constexpr double tolerated = 0.05, slack = 1 + 1e-6;
  if (times.size() < 2) return std::nullopt;
  const auto [shortest, longest] = range_of_steps(times);
  if (longest - shortest <= tolerated * shortest) return std::nullopt;
  const double usual = usual_step(times);
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double interval = times[i] - times[i - 1], deviation = std::abs(interval - usual);
    if (deviation <= tolerated * usual) continue;
    const double rounding = std::max(precision.resolution(times[i]), precision.resolution(times[i - 1]));
    const bool coarse = rounding > 0.5 * usual * slack;  // a missing sample would look the same
    if (coarse || deviation > (tolerated * usual + rounding) * slack)
      return SamplingFault{
          i, fmt::format(
                 "time {} after {}, an interval of {:.6g}; expected the median interval {:.6g} within 5 %{}",
                 times[i], times[i - 1], interval, usual, coarse ? too_coarse : "")};
  }
  return std::nullopt;
}

std::string count_of_columns(std::size_t count) {
  return fmt::format("{} column{}", count, count == 1 ? "" : "s");
}

InputError number_fault(const TextField& found, std::size_t column) {
  constexpr std::size_t longest = 40;
  const std::string shown =
      found.text.empty() ? "no entry" : fmt::format("'{}'", found.text.substr(0, longest));
  static const std::regex thousands(R"([-+]?[0-9]{1,3}([,.' ][0-9]{3})+([.,][0-9]+)?)");
  const char* expected = std::regex_match(found.text.substr(0, longest), thousands)
                             ? "a number without separators of thousands"
                         : parse_number(found.text).number ? "a finite number within double precision"
                         : found.text.find(',') != std::string::npos ? "a number with a decimal point"
                                                                     : "a number";
  return {found.place, fmt::format("column {} holds {}; expected {}", column + 1, shown, expected)};
}

std::size_t RowLines::operator[](std::size_t row) const {
  const auto after = std::ranges::upper_bound(runs_, row, {}, &Run::row);
  return std::prev(after)->line + (row - std::prev(after)->row);
}

bool RowLines::add(std::size_t line, std::size_t count) {
  const bool begins = runs_.empty() || line != runs_.back().line + (size_ - runs_.back().row);
  if (begins) runs_.push_back({size_, line});
  size_ += count;
  return begins;
}

void RowLines::keep(const std::vector<bool>& kept) {
  RowLines some;
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    const std::size_t end = k + 1 < runs_.size() ? runs_[k + 1].row : size_;
    for (std::size_t row = runs_[k].row; row < end; ++row)
      if (kept[row]) some.add(runs_[k].line + (row - runs_[k].row));
  }
  *this = std::move(some);
}

Place RecordTable::place(std::size_t row, std::size_t column) const {
  return cell ? cell(row, column).place : Place{file, 0, 0};
}

Place RecordTable::row_place(std::size_t row) const {
  return row < lines.size() ? Place{file, lines[row], 1} : Place{file, 0, 0};
}

InputError RecordTable::fault(std::size_t row, std::size_t column) const {
  if (!cell)
    return InputError({file, 0, 0}, fmt::format("sample {} of {} is {}; expected a finite number", row + 1,
                                                column < names.size() ? "'" + names[column] + "'"
                                                                      : fmt::format("column {}", column + 1),
                                                columns[column][row]));
  return number_fault(cell(row, column), column);
}

void RecordTable::keep(const std::vector<bool>& kept) {
  const auto compact = [&](auto& values) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (kept[i]) values[next++] = values[i];
    values.resize(next);
  };
  for (std::vector<double>& column : columns) compact(column);
  lines.keep(kept);
  if (!cell) return;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) rows.push_back(i);
  cell = [before = cell, rows](std::size_t row, std::size_t column) { return before(rows[row], column); };
}

std::string skipped_text(const std::vector<std::size_t>& lines, const std::string& why) {
  if (lines.empty()) return "";
  constexpr std::size_t most = 5;
  std::string places;
  for (std::size_t i = 0; i < std::min(lines.size(), most); ++i)
    places += (i ? ", " : "") + std::to_string(lines[i]);
  if (lines.size() > most) places += ", ...";
  return lines.size() == 1
             ? fmt::format("1 line is omitted, as it {}: line {}.", why, places)
             : fmt::format("{} lines are omitted, as each {}: lines {}.", lines.size(), why, places);
}

namespace {

constexpr const char* fallback = "delimited_text";

}  // namespace

RecordReaderRegistry& record_reader_registry() {
  static RecordReaderRegistry registry("reader");
  return registry;
}

std::string reader_of(const std::filesystem::path& file, const RecordFormat& format) {
  if (!format.reader.empty()) return record_reader_registry().find(format.reader).name;
  if (format.header_lines > 0 || format.separator != '\0') return fallback;
  std::ifstream stream = open_input(file, "a record of numbers in columns");
  std::string beginning(1024, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  for (const auto& [name, entry] : record_reader_registry().entries())
    if (name != fallback && record_reader_registry().make(name, {})->recognises(beginning)) return name;
  return fallback;
}

RecordTable read_table(const std::filesystem::path& file, const RecordFormat& format) {
  RecordTable table = record_reader_registry().make(reader_of(file, format), {})->read(file, format);
  for (auto* texts : {&table.names, &table.units, &table.remarks, &table.warnings})
    for (std::string& text : *texts) text = clean_text(text);
  return table;
}

std::string_view TextCells::Rows::line(std::size_t row) const {
  const Mark& mark = *std::prev(std::ranges::upper_bound(marks, row, {}, &Mark::row));
  std::string_view rest = std::string_view(*text).substr(mark.begin);
  std::string_view line = take_line(rest);
  for (std::size_t at = mark.row; at < row; ++at) line = take_line(rest);
  return line;
}

TextCells::TextCells(std::string file, std::shared_ptr<const std::string> text)
    : rows_(std::make_shared<Rows>(Rows{std::move(file), std::move(text), {}, {}})) {}

void TextCells::add(std::string_view line, std::size_t number, std::size_t count) {
  const std::size_t row = rows_->lines.size();
  if (rows_->lines.add(number, count) || row + count > rows_->marks.back().row + most_rows)
    rows_->marks.push_back({row, static_cast<std::size_t>(line.data() - rows_->text->data())});
}

std::function<TextField(std::size_t, std::size_t)> TextCells::cells(char separator,
                                                                    std::vector<std::size_t> columns) const {
  return [rows = rows_, separator, columns = std::move(columns)](std::size_t row, std::size_t column) {
    const std::string_view line = rows->line(row);
    std::vector<std::string_view> fields;
    split_fields(line, separator, fields);
    const std::size_t at = columns.empty() ? column : columns[column];
    if (at >= fields.size()) split_fields(line, separator, fields, true);  // it may hold nothing
    if (at >= fields.size()) return TextField{{rows->file, rows->lines[row], 1}, ""};
    const auto offset = static_cast<std::size_t>(fields[at].data() - line.data());
    return TextField{{rows->file, rows->lines[row], offset + 1}, std::string(fields[at])};
  };
}

}  // namespace beamid::experiments
