// LabVIEW measurement files: header blocks of keys, then columns; one block for each segment.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/record.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

// The lines of a LabVIEW measurement file, and the headers among them.

/// What a segment's header says of its channels; empty: nothing.
struct LvmSegment {
  std::vector<std::string> units, dimensions, x_units;
  std::vector<double> starts, intervals, samples;
  Place place = {};  ///< of the header's end

  bool over_time() const { return dimensions.empty() || dimensions[0] == "Time"; }
  std::string x_unit() const { return x_units.empty() ? "" : x_units[0]; }
};

/// Walks a file that is in memory.
class LvmLines {
 public:
  /// Behind the file's header, whose separator and decimal mark hold from there on.
  /// @param text must live as long as this
  /// @throws InputError where the header has no end.
  LvmLines(std::string file, std::string_view text);

  /// False at the file's end.
  bool next();
  /// Whether the line begins a block of keys, after rows or before the first of them.
  bool begins_segment() const;
  /// From there to its end. @throws InputError where it has none, or a number is none.
  LvmSegment read_segment();

  std::string_view line() const { return line_; }
  std::size_t number() const { return number_; }
  const std::vector<std::string_view>& fields() const { return fields_; }
  char separator() const { return separator_; }
  char decimal() const { return decimal_; }

  InputError bad(const std::string& message) const { return {{file_, number_, 1}, message}; }

 private:
  bool next_line();
  void read_file_header();
  std::vector<double> numbers(const std::vector<std::string>& words) const;

  std::string file_;
  std::string_view rest_, line_;
  std::size_t number_ = 0;
  char separator_ = '\t', decimal_ = '.';
  std::vector<std::string_view> fields_;
};

using std::string_view;
constexpr string_view end_of_header = "***End_of_Header***";

LvmLines::LvmLines(std::string file, string_view text) : file_(std::move(file)), rest_(text) {
  read_file_header();
}

bool LvmLines::next() {
  if (!next_line()) return false;
  split_fields(line_, separator_, fields_);
  return true;
}

bool LvmLines::next_line() {
  if (rest_.empty()) return false;
  line_ = take_line(rest_);
  ++number_;
  return true;
}

void LvmLines::read_file_header() {
  bool ended = false;
  char stated = '\t';
  while (!ended && next_line()) {
    if (number_ > 1)
      stated = line_.find('\t') != string_view::npos  ? '\t'
               : line_.find(',') != string_view::npos ? ','
                                                      : stated;
    split_fields(line_, stated, fields_);
    if (fields_.empty()) continue;
    ended = fields_[0] == end_of_header;
    const string_view value = fields_.size() > 1 ? fields_[1] : string_view();
    if (fields_[0] == "Separator") separator_ = value == "Comma" ? ',' : '\t';
    if (fields_[0] == "Decimal_Separator" && value == ",") decimal_ = ',';
    if (fields_[0] == "Decimal_Separator" && line_.ends_with(",")) decimal_ = ',';
  }
  if (!ended) throw bad(fmt::format("the file ends in its header; expected {}", end_of_header));
  if (separator_ == ',') decimal_ = '.';
}

bool LvmLines::begins_segment() const {
  static const char* const keys[] = {
      "Channels",    "Samples",  "Notes",   "Test_Name", "Test_Numbers",
      "Test_Series", "UUT_Name", "UUT_M/N", "UUT_S/N",   "***End_of_Header***"};
  return std::any_of(std::begin(keys), std::end(keys), [&](const char* key) { return fields_[0] == key; });
}

LvmSegment LvmLines::read_segment() {
  std::map<std::string, std::vector<std::string>, std::less<>> keys;
  bool special = false;
  for (bool ended = fields_[0] == end_of_header; !ended;) {
    if (!fields_.empty() && !special) {
      std::vector<std::string>& values = keys[std::string(fields_[0])];
      values.assign(fields_.begin() + 1, fields_.end());
    }
    if (!next_line())
      throw bad(fmt::format("the file ends in a segment's header; expected {}", end_of_header));
    split_fields(line_, separator_, fields_);
    if (fields_.empty()) continue;
    if (fields_[0].starts_with("***Start_Special***")) special = true;
    ended = fields_[0] == end_of_header;
    if (fields_[0].starts_with("***End_Special***")) special = false, fields_.clear();
  }
  const auto list = [&](const char* key) {
    const auto found = keys.find(key);
    return found == keys.end() ? std::vector<std::string>{} : found->second;
  };
  return {list("Y_Unit_Label"),     list("X_Dimension"),      list("X_Unit_Label"), numbers(list("X0")),
          numbers(list("Delta_X")), numbers(list("Samples")), {file_, number_, 1}};
}

std::vector<double> LvmLines::numbers(const std::vector<std::string>& words) const {
  std::vector<double> values;
  for (const std::string& word : words) {
    if (trimmed(word).empty()) continue;  // of a second X column
    const ParsedNumber parsed = parse_number(word, decimal_);
    if (!parsed.finite) throw bad(fmt::format("'{}' in a segment's header; expected a number", word));
    values.push_back(parsed.value);
  }
  return values;
}

// The instants of LabVIEW segments that have no X columns.

/// t_k = X0 + k Delta_X, each segment by its own header.
class LvmInstants {
 public:
  /// Those of a segment's rows. @param seconds of one unit of X; absent: the header tells no instants.
  /// @throws InputError at the header where its channels differ or it begins before the segment before ends.
  void add(const LvmSegment& segment, std::size_t rows, std::optional<double> seconds);

  const std::vector<double>& times() const {
    return times_;
  }  ///< [s]; of segments that tell none: no entries

  /// One clock for all of them; nothing where they do not follow each other at one interval.
  std::optional<Clock> clock() const;

 private:
  std::vector<double> times_;
  std::optional<Clock> first_;
  bool one_interval_ = true;
};

void LvmInstants::add(const LvmSegment& segment, std::size_t rows, std::optional<double> seconds) {
  if (rows == 0 || !seconds || segment.intervals.empty() || !(segment.intervals[0] > 0)) return;
  for (const auto* values : {&segment.starts, &segment.intervals})
    if (std::any_of(values->begin(), values->end(), [&](double value) { return value != values->front(); }))
      throw InputError(segment.place, "channels of different X0 or Delta_X; expected the same for all");
  const Clock clock{*seconds * (segment.starts.empty() ? 0.0 : segment.starts[0]),
                    *seconds * segment.intervals[0]};
  if (!first_) first_ = clock;
  one_interval_ = one_interval_ && std::abs(clock.interval / first_->interval - 1) < 1e-9;
  if (!times_.empty() && clock.start < times_.back() + 0.5 * clock.interval)
    throw InputError(segment.place,
                     fmt::format("a segment that begins at {:g} s, where the one before runs to {:g} s; "
                                 "expected segments in succession",
                                 clock.start, times_.back()));
  for (std::size_t k = 0; k < rows; ++k)
    times_.push_back(clock.start + static_cast<double>(k) * clock.interval);
}

std::optional<Clock> LvmInstants::clock() const {
  if (times_.empty() || !one_interval_) return std::nullopt;
  // Where a segment begins late all that follow do.
  const double last = first_->start + static_cast<double>(times_.size() - 1) * first_->interval;
  return std::abs(times_.back() - last) <= 0.5 * first_->interval ? first_ : std::nullopt;
}

/// Walks the lines of a measurement file and fills a table.
class LvmFile {
 public:
  LvmFile(const std::string& name, std::shared_ptr<const std::string> content, const RecordFormat& format)
      : content_(std::move(content)), lines_(name, *content_), cells_(name, content_), format_(format) {
    table_.file = name;
  }

  RecordTable read() {
    while (lines_.next()) {
      if (lines_.fields().empty()) continue;
      if (lines_.begins_segment())
        begin_segment();
      else if (!rows_begun_ && !holds_number(lines_.fields(), lines_.decimal()))
        read_names();
      else
        read_row();
    }
    finish();
    return std::move(table_);
  }

 private:
  void begin_segment() {
    end_segment();
    const LvmSegment before = std::exchange(segment_, lines_.read_segment());
    if (++segments_ > 1) check_like(before);
    rows_begun_ = false;
    rows_before_ = table_.lines.size();
  }

  /// Units hold for all segments; an absent label contradicts none.
  void check_like(const LvmSegment& before) {
    if (segment_.units.empty()) segment_.units = before.units;
    if (segment_.x_units.empty()) segment_.x_units = before.x_units;
    if (segment_.dimensions.empty()) segment_.dimensions = before.dimensions;
    const auto check = [&](const char* what, const std::vector<std::string>& now,
                           const std::vector<std::string>& then) {
      if (!then.empty() && now != then)
        throw InputError(segment_.place,
                         fmt::format("{} '{}' after '{}' in the segment before; expected the same", what,
                                     fmt::join(now, "', '"), fmt::join(then, "', '")));
    };
    check("Y_Unit_Label", segment_.units, before.units);
    check("X_Unit_Label", segment_.x_units, before.x_units);
    check("X_Dimension", segment_.dimensions, before.dimensions);
  }

  /// Of one unit of X; nothing where X is no time, or in a unit that the format states.
  std::optional<double> x_seconds() const {
    if (!segment_.over_time()) return std::nullopt;
    return seconds_per(segment_.x_unit(), "X", table_.file, format_);
  }

  /// Its instants, where it has no X columns, and whether it is whole.
  void end_segment() {
    const std::size_t rows = table_.lines.size() - rows_before_;
    const double stated =
        segment_.samples.empty() ? 0.0 : *std::max_element(segment_.samples.begin(), segment_.samples.end());
    if (segments_ > 0 && stated > 0 && stated != static_cast<double>(rows))
      table_.warnings.push_back(
          fmt::format("Segment {} has {} rows where its header states {:g} samples{}.", segments_, rows,
                      stated, static_cast<double>(rows) < stated ? ": the others are lost" : ""));
    if (!has_x_) instants_.add(segment_, rows, x_seconds());
  }

  /// "X_Value	Acceleration	Comment", or "X_Value	A	X_Value	B	Comment".
  void read_names() {
    std::vector<std::size_t> x, y;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < lines_.fields().size(); ++i) {
      if (lines_.fields()[i] == "X_Value") {
        x.push_back(i);
      } else if (lines_.fields()[i] != "Comment") {
        y.push_back(i);
        names.emplace_back(lines_.fields()[i]);
      }
    }
    if (y.empty()) return;
    keep_fastest(names, x, y);
    if (!channels_.empty() && names != channels_)
      throw lines_.bad(
          fmt::format("a segment of other channels; expected the {} of the first segment", channels_.size()));
    channels_ = names, x_ = x, y_ = y;
    if (segments_ == 1 && !slower_.empty())
      table_.remarks.push_back(fmt::format("Omitted, as of lower rates: {}.", slower_));
    table_.header_line = table_.header_line ? table_.header_line : lines_.number();
    rows_begun_ = true;
  }

  /// Channels of several rates stand side by side: those of the highest are kept, with their X.
  void keep_fastest(std::vector<std::string>& names, std::vector<std::size_t>& x,
                    std::vector<std::size_t>& y) {
    constexpr double alike = 1.0 + 1e-9;
    const std::vector<double> steps = segment_.intervals;
    has_unit_cells_ = segment_.units.size() > y.size() && x.size() > 1;  // one for each X, too
    kept_.clear(), slower_.clear();
    if (steps.size() != y.size()) return;
    const double fastest = *std::ranges::min_element(steps);
    for (std::size_t k = 0; k < y.size(); ++k)
      if (steps[k] <= alike * fastest)
        kept_.push_back(k);
      else
        slower_ += fmt::format("{}'{}'", slower_.empty() ? "" : ", ", names[k]);
    const auto pick = [&](auto& all) {
      if (all.size() != steps.size()) return;
      for (std::size_t k = 0; k < kept_.size(); ++k) all[k] = all[kept_[k]];
      all.resize(kept_.size());
    };
    pick(x), pick(y), pick(names), pick(segment_.starts), pick(segment_.intervals);
  }

  void begin_rows() {
    if (rows_begun_) return;
    rows_begun_ = true;
    if (!channels_.empty()) return;
    for (std::size_t i = 1; i < lines_.fields().size();
         ++i) {  // without headings: X first, then the channels
      y_.push_back(i);
      channels_.push_back(fmt::format("channel {}", i));
    }
    x_ = {0};
  }

  double value(std::size_t field) const {
    const ParsedNumber parsed = field < lines_.fields().size()
                                    ? parse_number(lines_.fields()[field], lines_.decimal())
                                    : ParsedNumber{};
    return parsed.finite ? parsed.value : std::numeric_limits<double>::quiet_NaN();
  }

  void read_row() {
    begin_rows();
    if (y_.empty() || y_.size() > 100000)
      throw lines_.bad("a row without channels; expected X_Value and one column each");
    if (values_.empty()) values_.resize(1 + y_.size()), precision_.resize(1 + y_.size());
    const bool has_x = !x_.empty() && x_[0] < lines_.fields().size() && !lines_.fields()[x_[0]].empty();
    if (table_.lines.empty()) has_x_ = has_x;
    if (table_.lines.size() == rows_before_ && has_x != has_x_)
      throw lines_.bad(
          fmt::format("a segment with{} X_Value; expected all of them alike", has_x ? "" : "out"));
    for (std::size_t k = 1; has_x_ && k < x_.size(); ++k)
      if (x_[k] < lines_.fields().size() && lines_.fields()[x_[k]] != lines_.fields()[x_[0]])
        throw InputError({table_.file, lines_.number(),
                          static_cast<std::size_t>(lines_.fields()[x_[k]].data() - lines_.line().data()) + 1},
                         fmt::format("X {} beside {}; expected channels sampled at the same instants",
                                     lines_.fields()[x_[k]], lines_.fields()[x_[0]]));
    if (has_x_) values_[0].push_back(value(x_[0]));
    if (has_x_ && std::isfinite(values_[0].back())) add_precision(0, lines_.fields()[x_[0]]);
    for (std::size_t k = 0; k < y_.size(); ++k) {
      values_[k + 1].push_back(value(y_[k]));
      if (std::isfinite(values_[k + 1].back())) add_precision(k + 1, lines_.fields()[y_[k]]);
    }
    cells_.add(lines_.line(), lines_.number());
    table_.lines.add(lines_.number());
  }

  void add_precision(std::size_t column, string_view token) {
    std::string pointed(token);
    std::replace(pointed.begin(), pointed.end(), ',', '.');
    precision_[column].add(pointed);
  }

  void add_time(std::string unit, std::vector<double> times, const PrintedPrecision& precision) {
    table_.names.emplace_back("X_Value"), table_.units.push_back(std::move(unit));
    table_.columns.push_back(std::move(times));
    table_.precision.push_back(precision);
  }

  void finish() {
    end_segment();
    if (table_.lines.empty())
      throw lines_.bad("no row of numbers; expected a segment with X_Value and channels");
    std::vector<std::size_t> fields;
    if (has_x_) {
      const std::string unit = segment_.x_unit();
      add_time(unit.empty() && segment_.over_time() ? "s" : unit, std::move(values_[0]), precision_[0]);
      fields.push_back(x_.empty() ? 0 : x_[0]);
      if (x_seconds() == 1.0) table_.time = 0;
    } else if (instants_.times().size() == table_.lines.size()) {
      table_.clock = instants_.clock();
      if (!table_.clock) {  // the instants stand in no field
        add_time("s", instants_.times(), PrintedPrecision::of_digits(15));
        fields.push_back(std::numeric_limits<std::size_t>::max());
        table_.time = 0;
      }
    }
    for (std::size_t k = 0; k < y_.size(); ++k) {
      table_.names.push_back(channels_[k]);
      const std::size_t label = has_unit_cells_ ? y_[k] - 1 : k < kept_.size() ? kept_[k] : k;
      table_.units.push_back(label < segment_.units.size() ? segment_.units[label] : "");
      table_.columns.push_back(std::move(values_[k + 1]));
      table_.precision.push_back(precision_[k + 1]);
      fields.push_back(y_[k]);
    }
    // Without labels the names are all there is; a cell that holds nothing is no gap here, but damage.
    table_.by_people =
        std::ranges::all_of(segment_.units, &std::string::empty) &&
        std::ranges::all_of(table_.columns, [](const std::vector<double>& column) {
          return std::ranges::all_of(column, [](double value) { return std::isfinite(value); });
        });
    if (segments_ > 1) table_.remarks.push_back(fmt::format("{} segments are joined.", segments_));
    table_.cell = cells_.cells(lines_.separator(), fields);
  }

  std::shared_ptr<const std::string> content_;
  LvmLines lines_;
  LvmSegment segment_;
  LvmInstants instants_;
  std::size_t segments_ = 0, rows_before_ = 0;
  TextCells cells_;
  const RecordFormat& format_;
  RecordTable table_;
  bool rows_begun_ = false, has_x_ = false;
  std::vector<std::string> channels_;
  std::string slower_;             ///< channels of lower rates
  std::vector<std::size_t> kept_;  ///< channels of the file that are those of the table
  bool has_unit_cells_ = false;
  std::vector<std::size_t> x_, y_;  ///< fields of X and of the channels
  std::vector<std::vector<double>> values_;
  std::vector<PrintedPrecision> precision_;
};

class LvmReader final : public RecordReader {
 public:
  bool recognises(string_view beginning) const override {
    return beginning.starts_with("LabVIEW Measurement") ||
           beginning.starts_with("\xEF\xBB\xBFLabVIEW Measurement");
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    constexpr const char* expected = "a LabVIEW measurement file";
    return LvmFile(file.string(), std::make_shared<const std::string>(read_text(file, expected)), format)
        .read();
  }
};

const bool lvm_registered = record_reader_registry().add(
    {"lvm",
     "LabVIEW measurement files: channels, units and sampling from their headers",
     "",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<LvmReader>(); }});

}  // namespace

}  // namespace beamid::experiments
