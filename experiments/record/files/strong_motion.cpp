// Strong-motion records of structures and ground: COSMOS and its predecessor of CSMIP [cosmos2001], several
// channels in one file, and SMC [converse1992], one; and three components, one after another, of GeoNet, New
// Zealand (V1A, V2A), and of the first volume of the California Institute of Technology as BHRC, Iran, and
// RENADIC, Chile, write it. Numbers stand in cells of fixed width, often with nothing between them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

using std::string_view;

/// One component of the motion at a station.
struct Series {
  std::string quantity;        ///< acceleration, velocity, displacement
  std::string name;            ///< "chan_1", "n28w"
  double interval = 0.0;       ///< [s]
  std::vector<double> values;  ///< in SI units; may be empty where the quantity is not read
};

/// "(8F10.5)" and "(10I8)": cells in a line, characters in a cell.
struct CellFormat {
  std::size_t cells = 0, width = 0;
};

class CellFile {
 public:
  explicit CellFile(const std::filesystem::path& file)
      : name_(file.string()), text_(read_text(file, "a strong-motion record")), lines_(lines_of(text_)) {}
  CellFile(const CellFile&) = delete;  // the lines are views into the text

  const std::string& name() const { return name_; }
  string_view text() const { return text_; }
  std::size_t lines() const { return lines_.size(); }

  string_view line(std::size_t at) const { return at < lines_.size() ? lines_[at] : string_view(); }

  /// @param line from 1; 0: of the whole file
  InputError bad(std::size_t line, const std::string& what) const { return {{name_, line, 0}, what}; }

  /// As many numbers as announced, from a line on. @returns the line behind them
  /// @throws InputError at a cell that is no number, and where the file ends before
  std::size_t take_numbers(std::size_t at, std::size_t count, CellFormat format,
                           std::vector<double>& values) const {
    values.clear();
    for (; values.size() < count; ++at) {
      if (at >= lines_.size())
        throw bad(lines_.size(), fmt::format("the file ends after {} of {} numbers", values.size(), count));
      const string_view line = lines_[at];
      for (std::size_t cell = 0; cell < format.cells && values.size() < count; ++cell) {
        const std::size_t from = cell * format.width;
        const string_view field = from < line.size() ? trimmed(line.substr(from, format.width)) : "";
        if (field.empty()) break;
        const ParsedNumber parsed = parse_number(field);
        if (!parsed.finite)
          throw InputError({name_, at + 1, from + 1},
                           fmt::format("'{}'; expected a number in {} characters", field, format.width));
        values.push_back(parsed.value);
      }
      if (trimmed(line).empty()) throw bad(at + 1, "an empty line within the numbers");
    }
    return at;
  }

  /// A stated count. @throws InputError at a line (from 1) unless it is 2 to 1e9
  std::size_t count_of(double stated, std::size_t line) const {
    if (!(stated >= 2.0) || !(stated < 1e9))
      throw bad(line, fmt::format("{:g} numbers; expected 2 at least and fewer than 1e9", stated));
    return static_cast<std::size_t>(stated);
  }

  /// To SI units. @throws InputError at a line (from 1) for a unit that is none of motion
  double factor_of(string_view unit, std::size_t line) const {
    const auto known = motion_unit(unit);
    if (known && (known->first == Quantity::acceleration || known->first == Quantity::velocity ||
                  known->first == Quantity::displacement))
      return known->second;
    throw bad(line,
              fmt::format("unit '{}'; expected cm/sec2, mm/sec2, g or g/10 of an acceleration, or cm and "
                          "cm/sec: counts have no scale here",
                          folded(unit)));
  }

 private:
  std::string name_, text_;
  std::vector<string_view> lines_;
};

/// The columns of all series of the first quantity; the others are counted in a remark.
/// @throws InputError where there is none, or their intervals or sizes differ
RecordTable table_of_series(const CellFile& file, std::vector<Series> series) {
  if (series.empty())
    throw file.bad(
        0,
        "no data in a unit of motion; expected a line such as '7000 acceleration pts', in cm/sec2 or g, "
        "and no raw counts");
  RecordTable table;
  table.file = file.name();
  const std::string quantity = series.front().quantity;
  const double interval = series.front().interval;
  table.clock = Clock{0.0, interval};
  const char* const unit = quantity == "acceleration" ? "m_per_s2" : quantity == "velocity" ? "m_per_s" : "m";
  std::size_t omitted = 0;
  std::set<std::string> names;
  for (Series& one : series) {
    omitted += one.quantity != quantity ? 1 : 0;
    if (one.quantity != quantity) continue;
    if ((table.width() > 0 && one.values.size() != table.rows()) || one.interval != interval)
      throw file.bad(
          0, fmt::format("channels of {} samples at {:g} s and of {} at {:g} s; expected one of both",
                         table.width() > 0 ? table.rows() : one.values.size(), interval, one.values.size(),
                         one.interval));
    std::string name = one.name;  // two of one direction occur
    for (int copy = 2; !names.insert(name).second; ++copy) name = fmt::format("{}_{}", one.name, copy);
    table.names.push_back(fmt::format("{}_{}_{}", quantity, name, unit));
    table.columns.push_back(std::move(one.values));
  }
  table.precision.assign(table.columns.size(), PrintedPrecision::of_digits(7));
  if (omitted > 0)
    table.remarks.push_back(fmt::format(
        "{} series of other quantities than {}, integrated from it or processed otherwise, are omitted.",
        omitted, quantity));
  return table;
}

/// A file of COSMOS, CSMIP or SMC.
class StrongMotionFile {
 public:
  explicit StrongMotionFile(const CellFile& file) : file_(file) {}

  std::vector<Series> read() {
    const bool smc = file_.line(1).starts_with('*');
    for (std::size_t at = 0; at < file_.lines();) at = smc ? read_smc() : read_line(at);
    return std::move(series_);
  }

 private:
  const CellFile& file_;
  std::vector<double> reals_;  ///< of the last real header of COSMOS
  std::string channel_;        ///< its name, where the headers state one
  std::vector<Series> series_;

  static CellFormat format_of(const std::string& line, CellFormat usual) {
    static const std::regex form(R"(\(\s*([0-9]{1,3})\s*[feig]([0-9]{1,3})(\.[0-9]+)?\s*\))",
                                 std::regex::icase);
    std::smatch match;
    if (!std::regex_search(line, match, form)) return usual;
    return {std::stoul(match[1]), std::stoul(match[2])};
  }

  /// One line of COSMOS or CSMIP and the numbers that it announces. @returns the line to go on with
  std::size_t read_line(std::size_t at) {
    static const std::regex reals(R"(^\s*([0-9]+)\s+Real-header values follow on\s+([0-9]+) lines)"),
        channel(R"(^\s*(?:Sta )?Cha?n?:?\s*([0-9]+)\b)"),
        cosmos(R"(^\s*([0-9]+)\s+(accel|veloc|displ)\w*\s+pts.*units=\s*([A-Za-z0-9/]+))", std::regex::icase),
        csmip(R"(^\s*([0-9]+)\s+points of (accel|veloc|displ)\w* data equally spaced at\s+([0-9.]+)\s*sec,)"
              R"(\s*in\s+([A-Za-z0-9/]+))",
              std::regex::icase),
        uncorrected(
            R"(^\s*([0-9]+)\s+(accel|veloc|displ)\w*\s+points at\s+([0-9.]+)\s*pts/sec in units of\s+)"
            R"(([A-Za-z0-9/]+))",
            std::regex::icase);
    constexpr std::size_t longest = 200, interval_ms = 61;
    const std::string line(file_.line(at).substr(0, longest));
    std::smatch match;
    const auto count = [&] { return file_.count_of(parse_number(match[1].str()).value, at + 1); };
    if (std::regex_search(line, match, channel)) channel_ = "chan_" + match[1].str();
    if (std::regex_search(line, match, reals))
      return file_.take_numbers(at + 1, count(), format_of(line, {6, 13}), reals_);
    const bool of_cosmos = std::regex_search(line, match, cosmos);
    const bool by_rate = !of_cosmos && std::regex_search(line, match, uncorrected);
    if (!of_cosmos && !by_rate && !std::regex_search(line, match, csmip)) return at + 1;
    Series one;
    const std::string word = folded(match[2].str());
    one.quantity = word.starts_with("acc")   ? "acceleration"
                   : word.starts_with("vel") ? "velocity"
                                             : "displacement";
    one.name = channel_.empty() ? fmt::format("chan_{}", series_.size() + 1) : channel_;
    one.interval = of_cosmos ? (reals_.size() > interval_ms ? 1e-3 * reals_[interval_ms] : 0.0)
                   : by_rate ? 1.0 / parse_number(match[3].str()).value
                             : parse_number(match[3].str()).value;
    if (!(one.interval > 0.0) || !std::isfinite(one.interval))
      throw file_.bad(at + 1,
                      "no interval between samples; expected the 62nd value of the real header, in ms");
    const double factor = file_.factor_of(match[of_cosmos ? 3 : 4].str(), at + 1);
    const std::size_t next = file_.take_numbers(at + 1, count(), format_of(line, {8, 10}), one.values);
    for (double& value : one.values) value *= factor;
    series_.push_back(std::move(one));
    return next;
  }

  /// The whole of a file of SMC: 11 lines of text, 48 whole numbers, of which the 16th and 17th count
  /// comments and samples, 50 real ones, of which the second is the rate, the comments, the samples.
  std::size_t read_smc() {
    constexpr std::size_t text = 11, whole = 48, real = 50, comments = 15, samples = 16, rate = 1;
    std::vector<double> integers;
    std::size_t at = file_.take_numbers(text, whole, {8, 10}, integers);
    at = file_.take_numbers(at, real, {5, 15}, reals_);
    if (!(reals_[rate] > 0.0) || !(reals_[rate] < 1e9))
      throw file_.bad(text + 1, "no rate; expected it in the header");
    const std::size_t count = file_.count_of(integers[samples], text + 1);
    at += static_cast<std::size_t>(std::clamp(integers[comments], 0.0, 1e9));
    while (file_.line(at).starts_with('|')) ++at;
    Series one;
    const char kind = file_.line(0).empty() ? ' ' : file_.line(0).front();
    one.quantity = kind == '3' ? "velocity" : kind == '4' ? "displacement" : "acceleration";
    one.name = "chan_1", one.interval = 1.0 / reals_[rate];
    file_.take_numbers(at, count, {8, 10}, one.values);
    for (double& value : one.values) value *= 0.01;  // of cm
    series_.push_back(std::move(one));
    return file_.lines();
  }
};

/// The first match among the lines of a component's header, with the line's number from 1; nothing without
/// one.
struct HeaderMatch {
  std::vector<std::string> groups;
  std::size_t line = 0;
  explicit operator bool() const { return line > 0; }
};

HeaderMatch find_in_header(const CellFile& file, std::size_t at, std::size_t lines, const std::regex& form) {
  constexpr std::size_t longest = 200;
  for (std::size_t k = at; k < at + lines; ++k) {
    const std::string line(file.line(k).substr(0, longest));
    std::smatch match;
    if (!std::regex_search(line, match, form)) continue;
    HeaderMatch found{{}, k + 1};
    for (const auto& group : match) found.groups.push_back(group.str());
    return found;
  }
  return {};
}

/// "N28W" -> "n28w": as part of a column's name.
std::string label_of(string_view text) {
  static const std::regex others("[^a-z0-9]");
  return std::regex_replace(folded(text), others, "_");
}

// GeoNet: 16 lines of text, 4 of whole and 6 of real numbers, then samples, 10 cells of 8 characters a line
// throughout. The counts of accelerations, velocities and displacements are the 34th to 36th number, the
// length of the processed record [s] the 64th, its interval [s] the 66th.

constexpr std::size_t geonet_text = 16, geonet_numbers = 100;

/// Intervals are printed to 0.1 ms. Where the length of the record, of as many samples or as many intervals,
/// shows that this rounded it (0.0078 s of 128 Hz), the interval is that of the length.
double geonet_interval(const CellFile& file, std::size_t line, double stated, double length,
                       std::size_t count) {
  constexpr double rounding = 5e-5, rounding_of_length = 6e-3;  // [s]
  if (stated > 0.0 && !(length > 0.0)) return stated;
  const auto samples = static_cast<double>(count);
  const double mean = length / samples, apart = std::abs(stated - mean);
  if (stated > 0.0 && apart <= (1.01 * stated + rounding_of_length) / samples) return stated;
  if (stated > 0.0 && apart <= 1.01 * rounding + stated / samples) return length / (samples - 0.5);
  throw file.bad(line, fmt::format("{} samples at {:g} s and a length of {:g} s; expected one record of both",
                                   count, stated, length));
}

/// One component. @returns the line behind it
std::size_t read_geonet(const CellFile& file, std::size_t at, std::vector<Series>& series) {
  static const std::regex direction(R"(^\s*Component\s+(\S+))"),
      peak(R"(^\s*Acceleration:\s+peak\s+\S+\s+(\S+)\s+at)", std::regex::icase),
      readings(R"(readings in units of\s+([0-9.]+)\s+(\S+))", std::regex::icase);
  const HeaderMatch named = find_in_header(file, at, geonet_text, direction),
                    unit = find_in_header(file, at, geonet_text, peak),
                    scale = find_in_header(file, at, geonet_text, readings);
  if (!named || (!unit && !scale))
    throw file.bad(at + 1, fmt::format("a component without {}; expected 'Component N28W' and 'Acceleration: "
                                       "Peak -22.0 mm/s/s at 51.15 s'",
                                       named ? "unit" : "direction"));
  const double factor =
      scale ? parse_number(scale.groups[1]).value * file.factor_of(scale.groups[2], scale.line)
            : file.factor_of(unit.groups[1], unit.line);
  constexpr CellFormat cells{10, 8};
  constexpr std::size_t accelerations = 33, velocities = 34, displacements = 35, length = 63, interval = 65;
  std::vector<double> header;
  at = file.take_numbers(at + geonet_text, geonet_numbers, cells, header);
  const std::size_t counts = at - 6, times = at - 3;  // their lines, from 1
  Series one{"acceleration", label_of(named.groups[1]), 0.0, {}};
  const std::size_t count = file.count_of(header[accelerations], counts);
  one.interval = geonet_interval(file, times, header[interval], header[length], count);
  at = file.take_numbers(at, count, cells, one.values);
  for (double& value : one.values) value *= factor;
  series.push_back(one);
  std::vector<double> integrated;
  for (const auto& [index, quantity] : {std::pair{velocities, "velocity"}, {displacements, "displacement"}}) {
    if (header[index] == 0.0) continue;
    at = file.take_numbers(at, file.count_of(header[index], counts), cells, integrated);
    series.push_back({quantity, one.name, one.interval, {}});
  }
  return at;
}

// The first volume: 13 lines of text, 7 of whole and 7 of real numbers, then 10 cells of equal width a line.
// RENADIC writes pairs of a time and a value, BHRC values at the rate that begins the second line of real
// numbers. Both end a component with "/&".

constexpr std::size_t volume_text = 13, volume_whole = 7, volume_real = 7, volume_cells = 10;

/// [s] of BHRC: by the rate, where it agrees with the length of the record, else by that length.
double volume_interval(const CellFile& file, std::size_t reals, double length, std::size_t count) {
  const double mean = length / static_cast<double>(count),
               rate = parse_number(trimmed(file.line(reals + 1).substr(0, 13))).value;
  return rate > 0.0 && std::abs(rate * mean - 1.0) < 0.01 ? 1.0 / rate : mean;
}

/// Every second number is a time. @returns the interval between them [s]
/// @throws InputError where they are not even to half of it: records that were digitised by hand
double part_pairs(const CellFile& file, std::size_t line, std::vector<double>& values) {
  const std::size_t count = values.size() / 2;
  const double first = values[0], interval = (values[2 * count - 2] - first) / static_cast<double>(count - 1);
  for (std::size_t k = 0; k < count; ++k) {
    if (!(std::abs(values[2 * k] - first - interval * static_cast<double>(k)) <= 0.5 * interval) ||
        !(interval > 0.0))
      throw file.bad(line,
                     fmt::format("time {:g} s of sample {}; expected pairs of a time and a value at even "
                                 "intervals of {:g} s. Write others as two columns of text",
                                 values[2 * k], k + 1, interval));
    values[k] = values[2 * k + 1];
  }
  values.resize(count);
  return interval;
}

/// One component. @returns the line behind it
std::size_t read_volume(const CellFile& file, std::size_t at, bool pairs, std::vector<Series>& series) {
  static const std::regex direction(R"(^\s*(COMP|CHAN)\s+([A-Z]+|[0-9]+))"),
      points(R"(NO\. OF POINTS\s*=\s*([0-9]+)\s+(?:DURATION|RECORD LENGTH)\s*=\s*([0-9.]+))"),
      units(R"(^\s*UNITS\b.*\bAND\s+([A-Z0-9/]+))");
  const HeaderMatch named = find_in_header(file, at, volume_text, direction),
                    size = find_in_header(file, at, volume_text, points),
                    unit = find_in_header(file, at, volume_text, units);
  for (const auto& [found, expected] : {std::pair{&named, "COMP L1"},
                                        {&size, "NO. OF POINTS =  9472  DURATION =  47.360"},
                                        {&unit, "UNITS ARE SECONDS AND G/10"}})
    if (!*found)
      throw file.bad(at + 1,
                     fmt::format("a component without '{}' in its {} lines of text; expected one such line",
                                 expected, volume_text));
  const double factor = file.factor_of(unit.groups[1], unit.line);
  const std::size_t count = file.count_of(parse_number(size.groups[1]).value, size.line),
                    numbers = pairs ? 2 * count : count, reals = at + volume_text + volume_whole,
                    data = reals + volume_real, cells = std::min(volume_cells, numbers),
                    length = file.line(data).find_last_not_of(" \t") + 1;
  if (length == 0 || length % cells != 0)
    throw file.bad(data + 1,
                   fmt::format("{} characters; expected {} numbers in cells of equal width", length, cells));
  Series one{"acceleration", (named.groups[1] == "CHAN" ? "chan_" : "") + label_of(named.groups[2]), 0.0, {}};
  at = file.take_numbers(data, numbers, {volume_cells, length / cells}, one.values);
  one.interval = pairs ? part_pairs(file, data + 1, one.values)
                       : volume_interval(file, reals, parse_number(size.groups[2]).value, count);
  for (double& value : one.values) value *= factor;
  series.push_back(std::move(one));
  return at;
}

enum class ComponentKind { none, geonet, values, pairs };

/// Of the lines that begin a component.
ComponentKind kind_of(string_view first, string_view second) {
  const std::string line = folded(first.substr(0, 60)), next = folded(second.substr(0, 60));
  if (line.starts_with("* vol1ds")) return ComponentKind::values;
  if (line.starts_with("uncorrected accelerogram data")) return ComponentKind::pairs;
  const bool accelerogram =
      line.starts_with("corrected accelerogram ") || line.starts_with("uncorrected accelerogram ");
  return accelerogram && trimmed(next).starts_with("site ") ? ComponentKind::geonet : ComponentKind::none;
}

/// Whether the file is one of GeoNet, of BHRC or of RENADIC.
bool holds_components(string_view beginning) {
  const std::size_t end = std::min(beginning.find('\n'), beginning.size());
  return kind_of(beginning.substr(0, end), beginning.substr(std::min(end + 1, beginning.size()))) !=
         ComponentKind::none;
}

/// Their accelerations; velocities and displacements, which were integrated from them, without values.
std::vector<Series> read_components(const CellFile& file) {
  std::vector<Series> series;
  for (std::size_t at = 0; at < file.lines();) {
    const string_view line = trimmed(file.line(at));
    const ComponentKind kind = kind_of(file.line(at), file.line(at + 1));
    if (kind == ComponentKind::geonet)
      at = read_geonet(file, at, series);
    else if (kind != ComponentKind::none)
      at = read_volume(file, at, kind == ComponentKind::pairs, series);
    else if (line.empty() || line.starts_with("/&"))
      ++at;
    else
      throw file.bad(at + 1,
                     fmt::format("'{}'; expected the first line of another component, or the end: the "
                                 "samples before it are as many as stated",
                                 line.substr(0, 40)));
  }
  return series;
}

class StrongMotionReader final : public RecordReader {
 public:
  bool recognises(string_view beginning) const override {
    static const std::regex smc(
        R"(^[1-4] (UNCORRECTED ACCELEROGRAM|CORRECTED ACCELEROGRAM|VELOCITY|DISPLACEMENT)[^\n]*\n\*)"),
        csmip(R"(^\s*(Unc|C)orrected (A|a)ccelerogram[^\n]*Chan +[0-9]+)");
    const string_view line = beginning.substr(0, beginning.find('\n'));
    return (line.find("(Format v") != line.npos && line.find("text lines)") != line.npos) ||
           std::regex_search(beginning.begin(), beginning.end(), smc) ||
           std::regex_search(line.begin(), line.end(), csmip) || holds_components(beginning);
  }

  RecordTable read(const std::filesystem::path& path, const RecordFormat&) const override {
    static const std::regex announced(R"([0-9]+ +Accelerogram points at )", std::regex::icase);
    constexpr std::size_t looked_at = 8000;
    const CellFile file(path);
    const string_view beginning = file.text().substr(0, looked_at);
    const bool components = holds_components(beginning) &&
                            !std::regex_search(beginning.begin(), beginning.end(), announced);  // of CSMIP
    return table_of_series(file, components ? read_components(file) : StrongMotionFile(file).read());
  }
};

const bool strong_motion_registered = record_reader_registry().add(
    {"strong_motion",
     "records of COSMOS, CSMIP (V1, V2), SMC, GeoNet (V1A, V2A), BHRC and RENADIC (V1): accelerations of all "
     "channels in m/s2",
     "[cosmos2001], [converse1992]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<StrongMotionReader>(); }});

}  // namespace
}  // namespace beamid::experiments
