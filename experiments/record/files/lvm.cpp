// LabVIEW measurement files: header blocks of keys, then columns; one block for each segment.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "experiments/record/files/lvm/lvm_instants.hpp"
#include "experiments/record/files/lvm/lvm_lines.hpp"
#include "experiments/record/record_reader.hpp"
#include "experiments/record/text_cells.hpp"
#include "experiments/record/time_unit.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/text_file.hpp"

namespace beamid::experiments {
namespace {

using std::string_view;

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
    if (!channels_.empty() && names != channels_)
      throw lines_.bad(
          fmt::format("a segment of other channels; expected the {} of the first segment", channels_.size()));
    channels_ = names, x_ = x, y_ = y;
    table_.header_line = table_.header_line ? table_.header_line : lines_.number();
    rows_begun_ = true;
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
    table_.lines.push_back(lines_.number());
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
      fields.push_back(x_[0]);
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
      table_.units.push_back(k < segment_.units.size() ? segment_.units[k] : "");
      table_.columns.push_back(std::move(values_[k + 1]));
      table_.precision.push_back(precision_[k + 1]);
      fields.push_back(y_[k]);
    }
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
