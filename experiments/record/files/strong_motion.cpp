// Strong-motion records of structures and ground as networks of the United States write them: COSMOS and its
// predecessor of CSMIP [cosmos2001], several channels in one file, and SMC [converse1992], one. Numbers stand
// in cells of fixed width, often with nothing between them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

using std::string_view;

/// One channel of the file.
struct Series {
  std::string quantity;   ///< acceleration, velocity, displacement
  std::string name;       ///< "chan_1"
  double interval = 0.0;  ///< [s]
  std::vector<double> values;
};

/// "(8F10.5)" and "(10I8)": cells in a line, characters in a cell.
struct CellFormat {
  std::size_t cells = 0, width = 0;
};

class StrongMotionFile {
 public:
  explicit StrongMotionFile(const std::filesystem::path& file)
      : name_(file.string()), text_(read_text(file, "a strong-motion record")), lines_(lines_of(text_)) {}

  RecordTable read() {
    const bool smc = lines_.size() > 1 && lines_[1].starts_with('*');
    for (std::size_t at = 0; at < lines_.size();) at = smc ? read_smc() : read_line(at);
    if (series_.empty()) throw bad(0, "no data; expected a line such as '7000 acceleration pts'");
    RecordTable table;
    table.file = name_;
    const Series& first = series_.front();
    table.clock = Clock{0.0, first.interval};
    std::size_t omitted = 0;
    for (Series& one : series_) {
      if (one.quantity != first.quantity) {
        ++omitted;
        continue;
      }
      if ((table.width() > 0 && one.values.size() != table.rows()) || one.interval != first.interval)
        throw bad(0, fmt::format("channels of {} samples at {:g} s and of {} at {:g} s; expected one of both",
                                 table.rows(), first.interval, one.values.size(), one.interval));
      const char* const unit = one.quantity == "acceleration" ? "m_per_s2"
                               : one.quantity == "velocity"   ? "m_per_s"
                                                              : "m";
      table.names.push_back(fmt::format("{}_{}_{}", one.quantity, one.name, unit));
      table.columns.push_back(std::move(one.values));
    }
    table.precision.assign(table.columns.size(), PrintedPrecision::of_digits(7));
    if (omitted > 0)
      table.remarks.push_back(
          fmt::format("{} series of other quantities than {}, integrated from it or "
                      "processed otherwise, are omitted.",
                      omitted, first.quantity));
    return table;
  }

 private:
  std::string name_, text_;
  std::vector<string_view> lines_;
  std::vector<double> reals_;  ///< of the last real header of COSMOS
  std::string channel_;        ///< its name, where the headers state one
  std::vector<Series> series_;

  InputError bad(std::size_t line, const std::string& what) const { return {{name_, line, 0}, what}; }

  static CellFormat format_of(const std::string& line, CellFormat usual) {
    static const std::regex form(R"(\(\s*([0-9]{1,3})\s*[feig]([0-9]{1,3})(\.[0-9]+)?\s*\))",
                                 std::regex::icase);
    std::smatch match;
    if (!std::regex_search(line, match, form)) return usual;
    return {std::stoul(match[1]), std::stoul(match[2])};
  }

  /// As many numbers as announced, from a line on. @returns the line behind them
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

  /// To SI units, of a length over a power of seconds; without the library of units, which may be missing.
  double factor_of(const std::string& unit, std::size_t line) const {
    static const std::regex metric("([cm])m(/s(ec)?2?(/s(ec)?)?)?");
    std::smatch match;
    if (std::regex_match(unit, match, metric)) return match[1] == "c" ? 0.01 : 0.001;
    if (unit == "gal") return 0.01;
    if (unit == "g") return standard_gravity;
    if (unit == "mg") return 1e-3 * standard_gravity;
    throw bad(line, fmt::format("unit '{}'; expected cm/sec2, mm/sec2 or g of an acceleration, or cm and "
                                "cm/sec: counts have no scale here",
                                unit));
  }

  static std::string quantity_of(const std::string& word) {
    return word.starts_with("acc") ? "acceleration" : word.starts_with("vel") ? "velocity" : "displacement";
  }

  /// One line of COSMOS or CSMIP and the numbers that it announces. @returns the line to go on with
  std::size_t read_line(std::size_t at) {
    static const std::regex reals(R"(^\s*([0-9]+)\s+Real-header values follow on\s+([0-9]+) lines)"),
        channel(R"(^\s*(?:Sta )?Cha?n?:?\s*([0-9]+)\b)"),
        cosmos(R"(^\s*([0-9]+)\s+(accel|veloc|displ)\w*\s+pts.*units=\s*([A-Za-z0-9/]+))", std::regex::icase),
        csmip(R"(^\s*([0-9]+)\s+points of (accel|veloc|displ)\w* data equally spaced at\s+([0-9.]+)\s*sec,)"
              R"(\s*in\s+([A-Za-z0-9/]+))",
              std::regex::icase);
    constexpr std::size_t longest = 200, interval_ms = 61;
    const std::string line(lines_[at].substr(0, longest));
    std::smatch match;
    const auto count_of = [&] {
      const double count = parse_number(match[1].str()).value;
      if (!(count < 1e9)) throw bad(at + 1, fmt::format("{} numbers; expected fewer than 1e9", count));
      return static_cast<std::size_t>(count);
    };
    if (std::regex_search(line, match, channel)) channel_ = "chan_" + match[1].str();
    if (std::regex_search(line, match, reals))
      return take_numbers(at + 1, count_of(), format_of(line, {6, 13}), reals_);
    const bool of_cosmos = std::regex_search(line, match, cosmos);
    if (!of_cosmos && !std::regex_search(line, match, csmip)) return at + 1;
    Series one;
    one.quantity = quantity_of(folded(match[2].str()));
    one.name = channel_.empty() ? fmt::format("chan_{}", series_.size() + 1) : channel_;
    one.interval = of_cosmos ? (reals_.size() > interval_ms ? 1e-3 * reals_[interval_ms] : 0.0)
                             : parse_number(match[3].str()).value;
    if (!(one.interval > 0.0) || !std::isfinite(one.interval))
      throw bad(at + 1, "no interval between samples; expected the 62nd value of the real header, in ms");
    const double factor = factor_of(folded(match[of_cosmos ? 3 : 4].str()), at + 1);
    const std::size_t next = take_numbers(at + 1, count_of(), format_of(line, {8, 10}), one.values);
    for (double& value : one.values) value *= factor;
    series_.push_back(std::move(one));
    return next;
  }

  /// The whole of a file of SMC: 11 lines of text, 48 whole numbers, of which the 16th and 17th count
  /// comments and samples, 50 real ones, of which the second is the rate, the comments, the samples.
  std::size_t read_smc() {
    constexpr std::size_t text = 11, whole = 48, real = 50, comments = 15, samples = 16, rate = 1;
    std::vector<double> integers;
    std::size_t at = take_numbers(text, whole, {8, 10}, integers);
    at = take_numbers(at, real, {5, 15}, reals_);
    if (!(integers[samples] > 1.0) || !(integers[samples] < 1e9) || !(reals_[rate] > 0.0) ||
        !(reals_[rate] < 1e9))
      throw bad(text + 1, "no count or no rate; expected both in the header");
    at += static_cast<std::size_t>(std::max(0.0, integers[comments]));
    while (at < lines_.size() && lines_[at].starts_with('|')) ++at;
    Series one;
    const char kind = lines_[0].front();
    one.quantity = kind == '3' ? "velocity" : kind == '4' ? "displacement" : "acceleration";
    one.name = "chan_1", one.interval = 1.0 / reals_[rate];
    take_numbers(at, static_cast<std::size_t>(integers[samples]), {8, 10}, one.values);
    for (double& value : one.values) value *= 0.01;  // of cm
    series_.push_back(std::move(one));
    return lines_.size();
  }
};

class StrongMotionReader final : public RecordReader {
 public:
  bool recognises(string_view beginning) const override {
    static const std::regex smc(
        R"(^[1-4] (UNCORRECTED ACCELEROGRAM|CORRECTED ACCELEROGRAM|VELOCITY|DISPLACEMENT)[^\n]*\n\*)"),
        csmip(R"(^\s*(Unc|C)orrected (A|a)ccelerogram[^\n]*Chan +[0-9]+)");
    const string_view line = beginning.substr(0, beginning.find('\n'));
    return (line.find("(Format v") != line.npos && line.find("text lines)") != line.npos) ||
           std::regex_search(beginning.begin(), beginning.end(), smc) ||
           std::regex_search(line.begin(), line.end(), csmip);
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    return StrongMotionFile(file).read();
  }
};

const bool strong_motion_registered = record_reader_registry().add(
    {"strong_motion",
     "records of COSMOS, CSMIP (V1, V2) and SMC: accelerations of all channels in m/s2",
     "[cosmos2001], [converse1992]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<StrongMotionReader>(); }});

}  // namespace
}  // namespace beamid::experiments
