#include "experiments/record/record_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <regex>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr const char* too_coarse =
    " (times printed this coarsely need the sampling rate: --rate HZ, or record.sampling_rate_hz)";

}  // namespace

std::optional<MissingRows> find_missing_rows(const std::vector<double>& times,
                                             const PrintedPrecision& precision) {
  constexpr double tolerated = 0.05, slack = 1 + 1e-6;
  constexpr std::size_t seldom = 100;  // rows between two lengthened intervals, at least
  if (times.size() < 3) return std::nullopt;
  const double usual = usual_step(times);
  MissingRows found;
  std::size_t doubtful = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double interval = times[i] - times[i - 1], steps = std::round(interval / usual),
                 rounding = std::max(precision.resolution(times[i]), precision.resolution(times[i - 1]));
    const double off = std::abs(interval - steps * usual);
    // What is printed to whole intervals has no rounding left about their multiples.
    if (steps < 1.0 || off > (tolerated * usual + (rounding < 0.5 * usual ? rounding : 0.0)) * slack)
      return std::nullopt;
    if (steps < 2.0) continue;
    if (interval - usual <= rounding * slack) ++doubtful;  // a rounding can do that, too
    if (found.places++ == 0 || steps - 1.0 > static_cast<double>(found.longest))
      found.longest = static_cast<std::size_t>(steps) - 1, found.before = i;
    found.rows += static_cast<std::size_t>(steps) - 1;
  }
  if (found.rows > times.size()) return std::nullopt;  // another record begins
  if (found.places == doubtful || seldom * doubtful > times.size()) return std::nullopt;
  return found;
}

void PrintedPrecision::add(std::string_view token) {
  int decimals = 0, digits = 0, exponent = 0;
  bool point = false;
  for (std::size_t i = 0; i < token.size(); ++i) {
    const char letter = token[i];
    if (letter >= '0' && letter <= '9') {
      decimals += point ? 1 : 0;
      digits += digits > 0 || letter != '0' ? 1 : 0;
    } else if (letter == '.') {
      point = true;
    } else if (letter == 'e' || letter == 'E' || letter == 'd' || letter == 'D') {
      const std::size_t start = i + (token.substr(i + 1).starts_with('+') ? 2 : 1);
      std::from_chars(token.data() + start, token.data() + token.size(), exponent);
      break;
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
  if (const auto missing = find_missing_rows(times, precision)) {
    const std::size_t i = missing->before;
    const std::string others =
        missing->places > 1 ? fmt::format(", {} at {} places in all", missing->rows, missing->places) : "";
    return SamplingFault{
        i, fmt::format("time {} after {}: {} row{} missing between them, at the median interval {:.6g}{}; "
                       "expected all rows, or [record] with stamps = \"as_they_are\" (usual) and malformed = "
                       "\"missing\", which takes their samples for not read, and missing_input = "
                       "\"leave_out\" where an input was measured",
                       times[i], times[i - 1], missing->longest, missing->longest == 1 ? " is" : "s are",
                       usual, others)};
  }
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
  if (std::find(kept.begin(), kept.end(), false) == kept.end()) return;
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
  constexpr std::ptrdiff_t most = 5;
  const auto end = lines.begin() + std::min(std::ssize(lines), most);
  std::string places = fmt::format("{}", fmt::join(lines.begin(), end, ", "));
  if (std::ssize(lines) > most) places += ", ...";
  return lines.size() == 1
             ? fmt::format("1 line is omitted, as it {}: line {}.", why, places)
             : fmt::format("{} lines are omitted, as each {}: lines {}.", lines.size(), why, places);
}

// Columns of a text that belong together: parts of a clock, blocks of rows.

namespace {

/// Hours, minutes, seconds and parts of them in columns of their own make the times.
void join_parts_of_clock(RecordTable& table) {
  struct Part {
    double seconds;
    std::set<std::string> names;
  };
  static const std::vector<Part> parts{
      {86400.0, {"day", "tag", "jour", "dia", "dd"}},
      {3600.0, {"hour", "hours", "hr", "h", "hh", "stunde", "heure", "hora"}},
      {60.0, {"minute", "minutes", "min", "m", "mm", "minuto"}},
      {1.0, {"second", "seconds", "sec", "s", "ss", "sekunde", "seconde", "segundo"}},
      {1e-3, {"millisecond", "milliseconds", "millis", "msec", "ms", "millisekunde"}},
      {1e-6, {"microsecond", "microseconds", "micros", "usec", "us"}}};
  if (table.time || table.names.size() != table.width() || table.rows() < 2) return;
  std::vector<std::optional<std::size_t>> found(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k)
    for (std::size_t index = table.width(); index-- > 0;)
      if (parts[k].names.contains(folded(table.names[index]))) found[k] = index;
  constexpr std::size_t minute = 2, second = 3, milli = 4;
  const bool rises_alone = found[second] && rises(table.columns[*found[second]]);
  if (!found[second] || (!found[minute] && !found[milli]) || (rises_alone && !found[milli])) return;
  for (std::size_t k = 1; k < parts.size(); ++k)  // 61 minutes are none
    if (found[k] && k != second)
      for (const double value : table.columns[*found[k]])
        if (!(value >= 0.0 && value < (k < second ? 60.0 : 1.0 / parts[k].seconds))) return;
  std::vector<double> sum(table.rows(), 0.0);
  PrintedPrecision precision;
  double finest = 1.0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!found[k]) continue;
    const std::vector<double>& values = table.columns[*found[k]];
    for (std::size_t row = 0; row < sum.size(); ++row) sum[row] += parts[k].seconds * values[row];
    finest = std::min(finest, parts[k].seconds * table.precision[*found[k]].resolution(values.back()));
  }
  constexpr double half_a_day = 43200.0, hour = 3600.0;  // past midnight, or past the full hour
  double passed = 0.0;
  for (std::size_t row = 1; row < sum.size(); ++row) {
    sum[row] += passed;
    const double period = found[0] ? 0.0 : found[1] ? 2.0 * half_a_day : hour;
    if (sum[row] < sum[row - 1] - 0.5 * period && period > 0.0) passed += period, sum[row] += period;
  }
  if (!rises(sum)) return;
  const int decimals = std::max(0, static_cast<int>(std::lround(-std::log10(finest))));
  precision.add(fmt::format("{:.{}f}", sum.back(), decimals));
  std::string list;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!found[k]) continue;
    list += fmt::format("{}'{}'", list.empty() ? "" : ", ", table.names[*found[k]]);
    static const char* const kept[] = {"day", "hour", "minute", "time", "millisecond", "millisecond 2"};
    table.names[*found[k]] = kept[k];
    if (*found[k] < table.units.size()) table.units[*found[k]].clear();
  }
  table.time = found[second];
  table.columns[*table.time] = std::move(sum);
  table.precision[*table.time] = precision;
  table.remarks.push_back(fmt::format("The times are the sum of {}.", list));
}

/// Hours, minutes and seconds in one number, 100055.250, as receivers of GNSS write them.
void take_clock_digits(RecordTable& table) {
  static const std::regex clock("(.*[^a-z])?(utc|gps|gnss|hhmmss|gpst)([^a-z].*)?"), any("time|uhrzeit");
  if (table.time || table.names.size() != table.width()) return;
  for (std::size_t index = 0; index < table.width(); ++index) {
    const std::vector<double>& values = table.columns[index];
    const std::string name = folded(table.names[index]);
    const bool jumps = std::regex_match(name, any) && !runs_evenly(values);  // from 100059.99 to 100100
    if (!(jumps || std::regex_match(name, clock)) || !rises(values)) continue;
    std::vector<double> seconds;
    for (const double value : values) {
      const double hours = std::floor(value / 1e4), minutes = std::floor(std::fmod(value, 1e4) / 100.0),
                   rest = std::fmod(value, 100.0);
      if (!(hours >= 0.0 && hours < 24.0 && minutes < 60.0 && rest < 60.0)) break;
      seconds.push_back(3600.0 * hours + 60.0 * minutes + rest);
    }
    if (seconds.size() != values.size() || !runs_evenly(seconds) || values.front() < 1e4) continue;
    table.columns[index] = std::move(seconds);
    table.time = index;
    table.remarks.push_back(fmt::format("'{}' is a clock in one number, hhmmss.", table.names[index]));
    return;
  }
}

/// The columns of a solution of RTKLIB, which has no other names: date, time, three coordinates, quality,
/// satellites, six deviations, age, ratio.
void name_solution(RecordTable& table) {
  constexpr std::size_t width = 15;
  constexpr double angle = 1e-8;  // printed for angles, in degrees
  if (!table.names.empty() || table.width() != width || table.time != 1) return;
  const auto within = [&](std::size_t index, double least, double most) {
    return std::ranges::all_of(table.columns[index], [&](double value) {
      return value >= least && value <= most && value == std::floor(value);
    });
  };
  if (!within(5, 1.0, 6.0) || !within(6, 0.0, 99.0)) return;
  const bool angles = table.precision[2].resolution(table.columns[2].back()) < angle;
  table.names = {"date",   "time",   "",        "",        "",        "Q",      "ns",   "sdn(m)",
                 "sde(m)", "sdu(m)", "sdne(m)", "sdeu(m)", "sdun(m)", "age(s)", "ratio"};
  const char* const places[2][3] = {{"e-baseline(m)", "n-baseline(m)", "u-baseline(m)"},
                                    {"latitude(deg)", "longitude(deg)", "height(m)"}};
  for (std::size_t k = 0; k < 3; ++k) table.names[k + 2] = places[angles ? 1 : 0][k];
  table.remarks.emplace_back("The columns are those of a solution of RTKLIB.");
}

/// Blocks of rows parted by blank lines, as gnuplot reads them: the times begin again in each. Blocks of the
/// same times are channels side by side. @throws InputError where their times differ
void join_blocks(RecordTable& table) {
  if (table.width() < 2 || table.lines.empty()) return;
  const std::vector<double>& rising = table.columns[0];
  std::vector<std::size_t> begins{0};
  for (std::size_t row = 1; row < table.rows(); ++row) {
    if (rising[row] > rising[row - 1]) continue;
    if (table.lines[row] < table.lines[row - 1] + 2) return;
    begins.push_back(row);
  }
  const std::size_t blocks = begins.size(), length = begins.size() > 1 ? begins[1] : 0;
  constexpr std::size_t fewest = 16, most = 64;
  if (blocks < 2 || length < fewest || blocks > most) return;
  begins.push_back(table.rows());
  for (std::size_t k = 0; k < blocks; ++k)
    for (std::size_t row = begins[k]; row < begins[k + 1]; ++row)
      if (begins[k + 1] - begins[k] != length || rising[row] != rising[row - begins[k]])
        throw InputError(
            {table.file, table.lines[begins[k]], 1},
            fmt::format("the first of {} rows of block {}: blank lines part {} blocks, each with "
                        "times of its own; expected a file for each block",
                        begins[k + 1] - begins[k], k + 1, blocks));
  RecordTable joined = table;
  joined.columns.assign(1, {rising.begin(), rising.begin() + static_cast<std::ptrdiff_t>(length)});
  joined.names.clear(), joined.units.clear(), joined.precision.assign(1, table.precision[0]);
  const auto named = [&](std::size_t column) {
    return column < table.names.size() ? table.names[column] : "";
  };
  if (!table.names.empty()) joined.names.push_back(named(0));
  if (!table.units.empty()) joined.units.push_back(table.units[0]);
  for (std::size_t k = 0; k < blocks; ++k)
    for (std::size_t column = 1; column < table.width(); ++column) {
      const auto from = table.columns[column].begin() + static_cast<std::ptrdiff_t>(begins[k]);
      joined.columns.emplace_back(from, from + static_cast<std::ptrdiff_t>(length));
      joined.precision.push_back(table.precision[column]);
      if (!table.names.empty()) joined.names.push_back(named(column));
      if (!table.units.empty())
        joined.units.push_back(column < table.units.size() ? table.units[column] : "");
    }
  joined.lines.clear(), joined.cell = nullptr;
  joined.remarks.push_back(
      fmt::format("Blank lines part {} blocks of the same times: channels side by side.", blocks));
  table = std::move(joined);
}

}  // namespace

void bring_in_order(RecordTable& table) {
  name_solution(table);
  join_parts_of_clock(table);
  take_clock_digits(table);
  join_blocks(table);
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
