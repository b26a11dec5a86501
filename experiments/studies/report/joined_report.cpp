#include "experiments/studies/report/joined_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "experiments/models/estimates.hpp"
#include "experiments/results/file.hpp"
#include "experiments/results/html.hpp"
#include "experiments/results/report_page.hpp"
#include "experiments/studies/report/joined_numbers.hpp"
#include "experiments/studies/report/report_methods.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/json_file.hpp"
#include "experiments/text/text_file.hpp"

namespace beamid::experiments {
namespace {

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
  sections.insert(sections.begin(), {"Methods and versions", methods_html(results, commands)});
  if (results.size() > 1)
    sections.insert(sections.begin(), {"Side by side", side_by_side_html(results, all)});
  replace_file(file, report_page(sections));
}

}  // namespace beamid::experiments
