// K-NET and KiK-net records of NIED, Japan: 17 lines of header, then counts, one component in each file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

using std::string_view;

constexpr std::size_t header_lines = 17, label_width = 18;
constexpr double gal = 0.01;  // [m/s2]

/// One component: a direction at one depth.
struct Component {
  std::string station, begin, direction;
  double rate = 0.0;                  ///< [Hz]
  std::vector<double> accelerations;  ///< their mean taken off [m/s2]
  double offset = 0.0;                ///< that mean [m/s2]

  /// Directions 1 to 3 are in the borehole, 4 to 6 at the surface, as are those by name.
  bool in_borehole() const { return direction == "1" || direction == "2" || direction == "3"; }
  const char* axis() const {
    constexpr const char* axes[] = {"ns", "ew", "ud"};
    if (direction.size() == 1 && direction[0] >= '1' && direction[0] <= '6')
      return axes[(direction[0] - '1') % 3];
    return direction == "N-S" ? axes[0] : direction == "E-W" ? axes[1] : axes[2];
  }
};

/// The header and the counts of one file.
class ComponentFile {
 public:
  explicit ComponentFile(const std::filesystem::path& file)
      : name_(file.string()), text_(read_text(file, "a K-NET or KiK-net record")) {}

  Component read() {
    split();
    Component one;
    one.station = value_of(6, "Station Code");
    one.begin = value_of(10, "Record Time");
    one.rate = positive_number(value_of(11, "Sampling Freq(Hz)"), 11);
    one.direction = value_of(13, "Dir.");
    const double per_count = scale(value_of(14, "Scale Factor"));
    for (std::size_t i = header_lines; i < lines_.size(); ++i) read_counts(i, per_count, one);
    if (one.accelerations.empty())
      throw InputError({name_, lines_.size(), 0},
                       "a header without counts; expected rows of whole numbers below it");
    double sum = 0.0;
    for (const double value : one.accelerations) sum += value;
    one.offset = sum / static_cast<double>(one.accelerations.size());
    for (double& value : one.accelerations) value -= one.offset;
    return one;
  }

 private:
  std::string name_, text_;
  std::vector<string_view> lines_;
  std::vector<string_view> fields_;

  void split() {
    lines_ = lines_of(text_);
    for (string_view& line : lines_) line = trimmed(line);
    while (!lines_.empty() && lines_.back().empty()) lines_.pop_back();
    if (lines_.size() < header_lines)
      throw InputError(
          {name_, lines_.size(), 0},
          fmt::format("{} lines; expected {} of header and the counts", lines_.size(), header_lines));
  }

  /// @param number of the line, from 1
  std::string value_of(std::size_t number, string_view label) const {
    const string_view line = lines_[number - 1];
    if (!line.starts_with(label))
      throw InputError({name_, number, 1},
                       fmt::format("'{}'; expected {}", line.substr(0, label_width), label));
    return std::string(trimmed(line.substr(label.size())));
  }

  double positive_number(string_view text, std::size_t number) const {
    while (!text.empty() && !(text.back() >= '0' && text.back() <= '9')) text.remove_suffix(1);  // "100Hz"
    const ParsedNumber parsed = parse_number(text, '.');
    if (!parsed.finite || !(parsed.value > 0.0))
      throw InputError({name_, number, 1}, fmt::format("'{}'; expected a positive number", text));
    return parsed.value;
  }

  /// "3920(gal)/6182761" -> [m/s2] of a count
  double scale(const std::string& text) const {
    const std::size_t unit = text.find("(gal)/");
    if (unit == std::string::npos)
      throw InputError({name_, 14, 1}, fmt::format("Scale Factor '{}'; expected 'NUMBER(gal)/NUMBER'", text));
    return gal * positive_number(string_view(text).substr(0, unit), 14) /
           positive_number(string_view(text).substr(unit + 6), 14);
  }

  void read_counts(std::size_t line, double per_count, Component& one) {
    split_fields(lines_[line], ' ', fields_);
    for (const string_view field : fields_) {
      const ParsedNumber count = parse_number(field, '.');
      if (!count.finite)
        throw InputError({name_, line + 1, static_cast<std::size_t>(field.data() - lines_[line].data()) + 1},
                         fmt::format("'{}'; expected a whole number of counts", field));
      one.accelerations.push_back(per_count * count.value);
    }
  }
};

/// The same direction at the other depth: of "X.NS1" it is "X.NS2".
std::optional<std::filesystem::path> other_depth(const std::filesystem::path& file) {
  std::string name = file.filename().string();
  if (name.empty() || (name.back() != '1' && name.back() != '2')) return std::nullopt;
  name.back() = name.back() == '1' ? '2' : '1';
  std::error_code ignored;
  const std::filesystem::path other = file.parent_path() / name;
  if (!std::filesystem::is_regular_file(other, ignored)) return std::nullopt;
  return other;
}

void add(const Component& one, RecordTable& table) {
  table.names.push_back(fmt::format("{}acceleration_{}_{}_m_per_s2", one.in_borehole() ? "base_" : "",
                                    one.in_borehole() ? "borehole" : "surface", one.axis()));
  table.units.emplace_back("m/s2");
  table.columns.push_back(one.accelerations);
  table.remarks.push_back(
      fmt::format("{}: the mean, {:.3g} m/s2, is taken off.", table.names.back(), one.offset));
}

class NiedReader final : public RecordReader {
 public:
  bool recognises(string_view beginning) const override {
    return beginning.starts_with("Origin Time") && beginning.find("Scale Factor") != string_view::npos;
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    const Component one = ComponentFile(file).read();
    RecordTable table;
    table.file = file.string();
    table.header_line = 0;
    table.clock = Clock{0.0, 1.0 / one.rate};
    const auto beside = other_depth(file);
    if (beside) {
      Component other = ComponentFile(*beside).read();
      if (other.station != one.station || other.begin != one.begin || other.rate != one.rate)
        table.warnings.push_back(
            fmt::format("{} is of another record (station, time or sampling frequency) and is omitted.",
                        beside->filename().string()));
      else
        return both(one, std::move(other), *beside, std::move(table));
    }
    add(one, table);
    table.precision.resize(1);
    return table;
  }

 private:
  static RecordTable both(Component one, Component other, const std::filesystem::path& beside,
                          RecordTable table) {
    const std::size_t samples = std::min(one.accelerations.size(), other.accelerations.size());
    if (one.accelerations.size() != other.accelerations.size())
      table.warnings.push_back(fmt::format("The two depths have {} and {} samples; the first {} are used.",
                                           one.accelerations.size(), other.accelerations.size(), samples));
    one.accelerations.resize(samples), other.accelerations.resize(samples);
    table.remarks.push_back(
        fmt::format("{} is read with it: one record of both depths.", beside.filename().string()));
    add(one.in_borehole() ? one : other, table);
    add(one.in_borehole() ? other : one, table);
    table.precision.resize(2);
    return table;
  }
};

const bool nied_registered = record_reader_registry().add(
    {"nied",
     "K-NET and KiK-net records: one component, with that of the other depth where it lies beside",
     "[aoi2004]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<NiedReader>(); }});

}  // namespace
}  // namespace beamid::experiments
