
#include "experiments/studies/report/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/models/estimates.hpp"
#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/report_page.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

// The numbers of a results.json by name, as they are compared with those of another.

/// A number of a results.json. Lists are entered by the names of their entries ("rayleigh, ekf, exponential",
/// "run1.csv"), modes by their frequency, never by their place.
struct JoinedNumber {
  std::string name;  ///< "rayleigh, ekf: bending stiffness [N m2]"
  double value = 0;
  double deviation = std::nan("");  ///< standard deviation; NaN: a plain number
};

/// Names for modes that are the same in several results.
class ModeNames {
 public:
  /// "mode at 3.456 Hz": that of the first frequency seen within 5 % of this one.
  std::string name(double frequency_hz);

 private:
  std::vector<double> known_;
};

/// All but configuration, diagnostics and histories, in the file's order.
std::vector<JoinedNumber> joined_numbers(const nlohmann::ordered_json& results, ModeNames& modes);

using Json = nlohmann::ordered_json;

constexpr std::string_view left_out[] = {
    "schema_version",  "configuration", "seed",          "diagnostics",  "files",
    "sections",        "rejected",      "stabilisation", "preparations", "channels",
    "singular_values", "innovations",   "noise_at_mode", "tables",       "messages"};
// What names an entry of a list.
constexpr std::string_view naming[] = {
    "name",   "record",         "structure", "beam",      "channel", "output", "law",   "reduction",
    "filter", "discretisation", "candidate", "parameter", "mode",    "step",   "cause", "scheme"};
constexpr std::string_view deviation_mark = "_standard_deviation";

/// Keys between which a reader loses nothing when they are not said.
bool is_container(std::string_view key) {
  return key == "parameters" || key == "runs" || key == "records" || key == "modes" || key == "points" ||
         key == "laws" || key == "structures" || key == "candidates" || key == "noise" || key == "plateaus";
}

std::string joined_name(const std::string& place, const std::string& key) {
  return place.empty() ? key : place + ": " + key;
}

/// Also the keys that vary in a sweep, "damping.ratio", name a point.
std::string entry_name(const Json& entry, ModeNames& modes) {
  std::string name;
  const auto add = [&](const std::string& text) {
    if (!text.empty()) name += (name.empty() ? "" : ", ") + text;
  };
  for (const auto& [key, value] : entry.items()) {
    const bool names = std::find(std::begin(naming), std::end(naming), key) != std::end(naming);
    if (names && value.is_string()) add(value.get<std::string>());
    if (names && value.is_number_integer()) add(key + " " + value.dump());
    if (key.find('.') != std::string::npos && value.is_primitive())
      add(key + " = " + (value.is_string() ? value.get<std::string>() : value.dump()));
  }
  if (name.empty() && entry.contains("frequency_hz") && entry["frequency_hz"].is_number())
    name = modes.name(entry["frequency_hz"].get<double>());
  return name;
}

class JoinedWalk {
 public:
  explicit JoinedWalk(ModeNames& modes) : modes_(modes) {}

  void object(const Json& json, const std::string& place) {
    for (const auto& [key, value] : json.items()) {
      if (std::find(std::begin(left_out), std::end(left_out), key) != std::end(left_out)) continue;
      const std::string inner = is_container(key) ? place : joined_name(place, key_label(key));
      if (value.is_number() && !is_deviation(json, key))
        add(joined_name(place, key_label(key)), value.get<double>(), deviation_beside(json, key));
      else if (value.is_object() && value.contains("estimate") && value["estimate"].is_number())
        estimate(value, joined_name(place, key_label(key)));
      else if (value.is_object())
        object(value, inner);
      else if (key == "runs" && value.is_array() && value.size() == 1 && value[0].is_object())
        object(value[0], inner);  // which one it is, the configuration says
      else if (value.is_array())
        array(value, inner);
    }
  }

  std::vector<JoinedNumber> found;

 private:
  /// "frequency_standard_deviation_hz" beside "frequency_hz".
  static bool is_deviation(const Json& json, std::string key) {
    const std::size_t at = key.find(deviation_mark);
    return at != std::string::npos && json.contains(key.erase(at, deviation_mark.size()));
  }

  static double deviation_beside(const Json& json, const std::string& key) {
    for (const auto& [other, value] : json.items())
      if (const std::size_t at = other.find(deviation_mark); at != std::string::npos && value.is_number())
        if (std::string(other).erase(at, deviation_mark.size()) == key) return value.get<double>();
    return std::nan("");
  }

  void estimate(const Json& json, std::string name) {
    const std::string unit = json.value("unit", Json()).is_string() ? json["unit"].get<std::string>() : "";
    if (!unit.empty() && name.back() != ']') name += " [" + unit + "]";
    const Json deviation = json.value("standard_deviation", Json());
    add(name, json["estimate"].get<double>(), deviation.is_number() ? deviation.get<double>() : std::nan(""));
  }

  void array(const Json& json, const std::string& place) {
    std::map<std::string, int> seen;
    for (const Json& entry : json) {
      if (!entry.is_object()) return;
      std::string name = entry_name(entry, modes_);
      if (name.empty()) continue;  // no name: not to be compared
      if (const int times = ++seen[name]; times > 1) name += fmt::format(" ({})", times);
      object(entry, joined_name(place, name));
    }
  }

  void add(const std::string& name, double value, double deviation) {
    found.push_back({name, value, deviation});
  }

  ModeNames& modes_;
};

std::string ModeNames::name(double frequency_hz) {
  constexpr double near = 0.05;
  for (const double known : known_)
    if (std::abs(frequency_hz - known) <= near * known) return fmt::format("mode at {:.4g} Hz", known);
  known_.push_back(frequency_hz);
  return fmt::format("mode at {:.4g} Hz", frequency_hz);
}

std::vector<JoinedNumber> joined_numbers(const Json& results, ModeNames& modes) {
  JoinedWalk walk(modes);
  walk.object(results, "");
  return std::move(walk.found);
}

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Name -> number of each result, names in the order of the files.
struct NumberSet {
  std::vector<std::string> names;
  std::vector<std::map<std::string, JoinedNumber>> values;
};

NumberSet number_set(const std::vector<NamedResults>& results) {
  NumberSet set;
  ModeNames modes;
  for (const NamedResults& one : results) {
    set.values.emplace_back();
    for (const JoinedNumber& number : joined_numbers(one.json, modes))
      if (set.values.back().emplace(number.name, number).second &&
          std::find(set.names.begin(), set.names.end(), number.name) == set.names.end())
        set.names.push_back(number.name);
  }
  return set;
}

/// Of each result the number of this name; none where it has none.
std::vector<const JoinedNumber*> joined_row(const NumberSet& set, const std::string& name) {
  std::vector<const JoinedNumber*> row;
  for (const auto& values : set.values) {
    const auto at = values.find(name);
    row.push_back(at == values.end() ? nullptr : &at->second);
  }
  return row;
}

bool in_two_results(const std::vector<const JoinedNumber*>& row) {
  return std::count(row.begin(), row.end(), nullptr) + 2 <= static_cast<std::ptrdiff_t>(row.size());
}

bool is_estimate(const std::vector<const JoinedNumber*>& row) {
  return std::any_of(row.begin(), row.end(),
                     [](const JoinedNumber* one) { return one && std::isfinite(one->deviation); });
}

/// "3.455519 +- 0.000080", two digits of the half width of the 95 % interval.
std::string with_interval(const JoinedNumber& number) {
  const double half = quantile_95 * number.deviation;
  if (!(half > 0) || !std::isfinite(half)) return fmt::format("{:.6g}", number.value);
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(half)));
  if (decimals < 0 || decimals > 9) return fmt::format("{:.6g} +- {:.2g}", number.value, half);
  return fmt::format("{:.{}f} +- {:.{}f}", number.value, decimals, half, decimals);
}

double percent_between(double first, double second) {
  return first == 0.0 ? std::nan("") : 100.0 * (second / first - 1.0);
}

NamedResults read_results(const fs::path& folder) {
  const fs::path file = folder / "results.json";
  NamedResults read{folder.lexically_normal().filename().string(), {}};
  if (read.name.empty() || read.name == ".")
    read.name = fs::absolute(folder).lexically_normal().parent_path().filename();
  read.json = read_json(file, "the results of a beamid command");
  if (read.json.value("program", Json()) != "beamid")
    throw InputError({file.string()}, "not written by beamid; expected the results of one of its commands");
  for (const char* key : {"command", "version"})
    if (!read.json.value(key, Json()).is_string())
      throw InputError({file.string()},
                       fmt::format("no text '{}'; expected the results of a beamid command", key));
  const fs::path timing = folder / "timing.json";
  const Json times = fs::exists(timing) ? read_json(timing, "the times of a beamid command") : Json::object();
  if (times.contains("made_with") && times["made_with"].is_object()) read.made_with = times["made_with"];
  return read;
}

/// What differs first, then the parameters, then what else differs.
std::string side_by_side_html(const std::vector<NamedResults>& results, bool all) {
  std::string html = "<h1>Side by side</h1>\n";
  const Table differences = configuration_differences(results);
  html += differences.rows() > 0 ? html_table(differences) : "<p>The configurations are the same.</p>\n";
  const Table parameters = parameters_side_by_side(results), numbers = numbers_side_by_side(results, all);
  html += parameters.rows() > 0
              ? html_table(parameters)
              : "<p>No estimate with a standard deviation has the same name in two of them.</p>\n";
  if (numbers.rows() > 0) html += html_table(numbers);
  return html;
}

}  // namespace

Table parameters_side_by_side(const std::vector<NamedResults>& results) {
  const NumberSet set = number_set(results);
  const bool two = results.size() == 2;
  Table table{"parameters_side_by_side", "Parameters, with 95 % intervals"};
  table.column({"parameter", "parameter"});
  for (const NamedResults& one : results) table.column({one.name, one.name});
  if (two)
    table.column({"difference [%]", "difference_percent", "{:+.3g}"})
        .column({"in combined standard deviations", "difference_in_standard_deviations", "{:+.1f}"});
  for (const std::string& name : set.names) {
    const auto row = joined_row(set, name);
    if (!in_two_results(row) || !is_estimate(row)) continue;
    std::vector<Cell> cells{name};
    for (const JoinedNumber* one : row) cells.emplace_back(one ? with_interval(*one) : std::string("-"));
    if (two) {
      const double both = std::hypot(row[0]->deviation, row[1]->deviation);
      cells.emplace_back(percent_between(row[0]->value, row[1]->value));
      cells.emplace_back(both > 0 ? (row[1]->value - row[0]->value) / both : std::nan(""));
    }
    table.row(std::move(cells));
  }
  if (two)
    table.note =
        "Combined standard deviation: the root of the sum of both variances, as of independent records; on "
        "the same record it is too large. Beyond 2 the two differ significantly (95 %).";
  return table;
}

Table numbers_side_by_side(const std::vector<NamedResults>& results, bool all) {
  constexpr std::string_view of_runs[] = {"response error [%]", "rms error [%]", "bias [%]",
                                          "rms over bound"};
  const NumberSet set = number_set(results);
  Table table{"side_by_side", "Other numbers that differ"};
  table.column({"result", "result"});
  for (const NamedResults& one : results) table.column({one.name, one.name, "{:.6g}"});
  const bool two = results.size() == 2;
  if (two) table.column({"difference [%]", "difference_percent", "{:+.3g}"});
  for (const std::string& name : set.names) {
    const auto row = joined_row(set, name);
    if (!in_two_results(row) || is_estimate(row)) continue;
    const bool whole = name.find(": ") == std::string::npos;
    if (!all && !whole && std::none_of(std::begin(of_runs), std::end(of_runs), [&](std::string_view key) {
          return name.ends_with(std::string(": ").append(key));
        }))
      continue;
    std::vector<Cell> cells{name};
    std::vector<double> found;
    for (const JoinedNumber* one : row) {
      cells.emplace_back(one ? one->value : std::nan(""));
      if (one) found.push_back(one->value);
    }
    if (std::equal(found.begin() + 1, found.end(), found.begin())) continue;
    if (two) cells.emplace_back(percent_between(found[0], found[1]));
    table.row(std::move(cells));
  }
  return table;
}

void write_joined_report(const std::vector<fs::path>& folders, const fs::path& file, bool all) {
  std::vector<NamedResults> results;
  std::vector<ReportSection> sections;
  std::vector<std::string> commands;
  for (const fs::path& folder : folders) {
    results.push_back(read_results(folder));
    const fs::path page = folder / "report.html";
    std::vector<ReportSection> found = sections_of(read_text(page, "the page of a beamid command"));
    if (found.empty())
      throw InputError({page.string()}, "no page of beamid; expected the one that --out has written");
    for (const ReportSection& section : found)
      if (const std::string tag = foreign_tag(section.html); !tag.empty())
        throw InputError(
            {page.string()},
            fmt::format("<{}>, which beamid does not write; expected a page as --out wrote it", tag));
    commands.push_back(command_of(found[0]));
    for (ReportSection& section : found) {
      section.title = results.back().name + ": " + section.title;
      sections.push_back(std::move(section));
    }
  }
  // Of one folder its page comes first, of several what distinguishes them.
  sections.insert(results.size() > 1 ? sections.begin() : sections.end(),
                  {"Methods and versions", methods_html(results, commands)});
  if (results.size() > 1)
    sections.insert(sections.begin(), {"Side by side", side_by_side_html(results, all)});
  replace_file(file, report_page(sections));
}

}  // namespace beamid::experiments
