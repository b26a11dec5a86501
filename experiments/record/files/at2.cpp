// Strong-motion records of PEER [at2]: four lines of header, then the samples, several in a line.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <regex>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr std::size_t at2_lines = 4;

struct At2Header {
  std::size_t count;
  double interval;  ///< [s]
};

/// Of "NPTS=  5372, DT=   .0050 SEC" or "5372 0.0050 NPTS, DT".
std::optional<At2Header> at2_header(std::string_view line) {
  static const std::regex named(R"(NPTS\s*=\s*([0-9]+)\s*,?\s*DT\s*=\s*([0-9.eE+-]+))"),
      followed(R"(^\s*([0-9]+)\s+([0-9.eE+-]+)\s+NPTS\s*,\s*DT)");
  std::match_results<std::string_view::const_iterator> match;
  if (!std::regex_search(line.begin(), line.end(), match, named) &&
      !std::regex_search(line.begin(), line.end(), match, followed))
    return {};
  const ParsedNumber count = parse_number(match[1].str()), interval = parse_number(match[2].str());
  constexpr double most = 1e9;
  if (!interval.finite || !(interval.value > 0.0) || !(count.value <= most)) return {};
  return At2Header{static_cast<std::size_t>(count.value), interval.value};
}

class At2Reader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    const std::vector<std::string_view> lines = lines_of(beginning);
    return lines.size() >= at2_lines && at2_header(lines[at2_lines - 1]).has_value();
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    const std::string text = read_text(file, "a record of PEER");
    std::vector<std::string_view> lines = lines_of(text);
    if (lines.size() < at2_lines) lines.resize(at2_lines);
    const std::string_view words = lines[at2_lines - 2], counts = lines[at2_lines - 1];
    const auto header = at2_header(counts);
    if (!header)
      throw InputError({file.string(), at2_lines, 1},
                       fmt::format("'{}'; expected the count and the interval: NPTS= 5372, DT= .0050 SEC",
                                   counts.substr(0, 60)));
    RecordTable table;
    table.file = file.string();
    table.clock = Clock{0.0, header->interval};
    table.columns.resize(1);
    std::vector<std::string_view> fields;
    for (std::size_t k = at2_lines; k < lines.size(); ++k) {
      split_fields(lines[k], ' ', fields);
      for (const std::string_view field : fields) {
        const ParsedNumber parsed = parse_number(field);
        if (!parsed.finite)
          throw InputError(
              {file.string(), k + 1, static_cast<std::size_t>(field.data() - lines[k].data()) + 1},
              fmt::format("'{}'; expected a number", field));
        table.columns[0].push_back(parsed.value);
      }
    }
    if (table.rows() != header->count)
      throw InputError({file.string(), 0, 0},
                       fmt::format("{} samples; expected {}, as line 4 states", table.rows(), header->count));
    table.precision = {PrintedPrecision::of_digits(7)};
    const bool velocity = words.starts_with("VEL"), displacement = words.starts_with("DIS");
    const Quantity quantity = velocity       ? Quantity::velocity
                              : displacement ? Quantity::displacement
                                             : Quantity::acceleration;
    const double unit = quantity == Quantity::acceleration ? standard_gravity : 1e-3;  // of the name below
    double factor = quantity == Quantity::acceleration ? 1.0 : 10.0;                   // in g, or of cm
    if (const auto stated = unit_of_statement(words); stated && stated->first == quantity)
      factor = stated->second / unit;  // "IN UNITS OF M/S/S", as others write the form
    for (double& value : table.columns[0]) value *= factor;
    table.names = {velocity ? "velocity_mm_per_s" : displacement ? "displacement_mm" : "acceleration_g"};
    return table;
  }
};

const bool at2_registered = record_reader_registry().add(
    {"at2",
     "strong-motion records of PEER: acceleration in g, velocity or displacement in cm, several in a line",
     "[at2]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<At2Reader>(); }});

}  // namespace
}  // namespace beamid::experiments
