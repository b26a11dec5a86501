// LabVIEW measurement files: header blocks of keys, then columns; one block for each segment.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "experiments/input/fields.hpp"
#include "experiments/input/record_reader.hpp"
#include "experiments/input/text_cells.hpp"
#include "experiments/input/text_file.hpp"

namespace beamid::experiments {
namespace {

using std::string_view;
using Fields = std::vector<string_view>;

constexpr string_view end_of_header = "***End_of_Header***";

/// Walks the lines of a measurement file and fills a table.
class LvmFile {
 public:
  LvmFile(const std::string& name, std::shared_ptr<const std::string> content)
      : content_(std::move(content)), rest_(*content_), cells_(name, content_) {
    table_.file = name;
  }

  RecordTable read() {
    read_file_header();
    while (next_line()) {
      split_fields(line_, separator_, fields_);
      if (fields_.empty()) continue;
      if (begins_segment())
        read_segment_header();
      else if (!rows_begun_ && !holds_number(fields_, decimal_))
        read_names();
      else
        read_row();
    }
    finish();
    return std::move(table_);
  }

 private:
  InputError bad(const std::string& message) const { return {{table_.file, number_, 1}, message}; }

  bool next_line() {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(rest_.size(), end + (rest_.substr(end).starts_with("\r\n") ? 2 : 1)));
    ++number_;
    return true;
  }

  /// The key and what stands after it; several values in a segment's header.
  void read_file_header() {
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

  /// A block of keys after rows, or before the first of them.
  bool begins_segment() const {
    static const char* const keys[] = {
        "Channels",    "Samples",  "Notes",   "Test_Name", "Test_Numbers",
        "Test_Series", "UUT_Name", "UUT_M/N", "UUT_S/N",   "***End_of_Header***"};
    return std::any_of(std::begin(keys), std::end(keys), [&](const char* key) { return fields_[0] == key; });
  }

  void read_segment_header() {
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
    units_ = list("Y_Unit_Label");
    starts_ = numbers(list("X0"));
    intervals_ = numbers(list("Delta_X"));
    dimensions_ = list("X_Dimension");
    rows_begun_ = false;
    ++segments_;
  }

  std::vector<double> numbers(const std::vector<std::string>& words) const {
    std::vector<double> values;
    for (const std::string& word : words) {
      const ParsedNumber parsed = parse_number(word, decimal_);
      if (!parsed.finite) throw bad(fmt::format("'{}' in a segment's header; expected a number", word));
      values.push_back(parsed.value);
    }
    return values;
  }

  /// "X_Value	Acceleration	Comment", or "X_Value	A	X_Value	B	Comment".
  void read_names() {
    std::vector<std::size_t> x, y;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (fields_[i] == "X_Value") {
        x.push_back(i);
      } else if (fields_[i] != "Comment") {
        y.push_back(i);
        names.emplace_back(fields_[i]);
      }
    }
    if (y.empty()) return;
    if (!channels_.empty() && names != channels_)
      throw bad(
          fmt::format("a segment of other channels; expected the {} of the first segment", channels_.size()));
    channels_ = names, x_ = x, y_ = y;
    table_.header_line = table_.header_line ? table_.header_line : number_;
    rows_begun_ = true;
  }

  void begin_rows() {
    if (rows_begun_) return;
    rows_begun_ = true;
    if (!channels_.empty()) return;
    for (std::size_t i = 1; i < fields_.size(); ++i) {  // without headings: X first, then the channels
      y_.push_back(i);
      channels_.push_back(fmt::format("channel {}", i));
    }
    x_ = {0};
  }

  double value(std::size_t field) const {
    const ParsedNumber parsed =
        field < fields_.size() ? parse_number(fields_[field], decimal_) : ParsedNumber{};
    return parsed.finite ? parsed.value : std::numeric_limits<double>::quiet_NaN();
  }

  void read_row() {
    begin_rows();
    if (y_.empty() || y_.size() > 100000)
      throw bad("a row without channels; expected X_Value and one column each");
    if (values_.empty()) values_.resize(1 + y_.size()), precision_.resize(1 + y_.size());
    const bool has_x = !x_.empty() && x_[0] < fields_.size() && !fields_[x_[0]].empty();
    if (table_.lines.empty()) has_x_ = has_x;
    for (std::size_t k = 1; has_x_ && k < x_.size(); ++k)
      if (x_[k] < fields_.size() && fields_[x_[k]] != fields_[x_[0]])
        throw InputError(
            {table_.file, number_, static_cast<std::size_t>(fields_[x_[k]].data() - line_.data()) + 1},
            fmt::format("X {} beside {}; expected channels sampled at the same instants", fields_[x_[k]],
                        fields_[x_[0]]));
    values_[0].push_back(has_x_ ? value(x_[0]) : 0.0);
    if (has_x_ && std::isfinite(values_[0].back())) add_precision(0, fields_[x_[0]]);
    for (std::size_t k = 0; k < y_.size(); ++k) {
      values_[k + 1].push_back(value(y_[k]));
      if (std::isfinite(values_[k + 1].back())) add_precision(k + 1, fields_[y_[k]]);
    }
    cells_.add(line_, number_);
    table_.lines.push_back(number_);
  }

  void add_precision(std::size_t column, string_view token) {
    std::string pointed(token);
    std::replace(pointed.begin(), pointed.end(), ',', '.');
    precision_[column].add(pointed);
  }

  void finish() {
    if (table_.lines.empty()) throw bad("no row of numbers; expected a segment with X_Value and channels");
    std::vector<std::size_t> fields;
    if (has_x_) {
      table_.names.emplace_back("X_Value"), table_.units.emplace_back("s");
      table_.columns.push_back(std::move(values_[0]));
      table_.precision.push_back(precision_[0]);
      fields.push_back(x_[0]);
      if (dimensions_.empty() || dimensions_[0] == "Time") table_.time = 0;
    } else if (!intervals_.empty() && intervals_[0] > 0) {
      if (std::any_of(intervals_.begin(), intervals_.end(), [&](double dx) { return dx != intervals_[0]; }))
        throw bad("channels of different Delta_X; expected the same for all");
      table_.clock = {starts_.empty() ? 0.0 : starts_[0], intervals_[0]};
    }
    for (std::size_t k = 0; k < y_.size(); ++k) {
      table_.names.push_back(channels_[k]);
      table_.units.push_back(k < units_.size() ? units_[k] : "");
      table_.columns.push_back(std::move(values_[k + 1]));
      table_.precision.push_back(precision_[k + 1]);
      fields.push_back(y_[k]);
    }
    if (segments_ > 1) table_.remarks.push_back(fmt::format("{} segments are joined.", segments_));
    table_.cell = cells_.cells(separator_, fields);
  }

  std::shared_ptr<const std::string> content_;
  string_view rest_, line_;
  std::size_t number_ = 0, segments_ = 0;
  char separator_ = '\t', decimal_ = '.';
  Fields fields_;
  TextCells cells_;
  RecordTable table_;
  bool rows_begun_ = false, has_x_ = false;
  std::vector<std::string> units_, dimensions_, channels_;
  std::vector<double> starts_, intervals_;
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

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    constexpr const char* expected = "a LabVIEW measurement file";
    return LvmFile(file.string(), std::make_shared<const std::string>(read_text(file, expected))).read();
  }
};

const bool registered = record_reader_registry().add(
    {"lvm",
     "LabVIEW measurement files: channels, units and sampling from their headers",
     "",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<LvmReader>(); }});

}  // namespace
}  // namespace beamid::experiments
