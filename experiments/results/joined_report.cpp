#include "experiments/results/joined_report.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "experiments/results/file.hpp"
#include "experiments/results/html.hpp"
#include "experiments/results/report_methods.hpp"
#include "experiments/results/report_page.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/json_file.hpp"
#include "experiments/text/text_file.hpp"

namespace beamid::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t most_entries = 8;  // of a list: longer ones are histories

/// "parameters.stiffness.estimate" -> value, in the file's order.
using Numbers = std::vector<std::pair<std::string, double>>;

void collect(const Json& json, const std::string& place, Numbers& numbers) {
  if (json.is_number()) {
    numbers.emplace_back(place, json.get<double>());
  } else if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      collect(value, place.empty() ? key : place + "." + key, numbers);
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < std::min(json.size(), most_entries); ++i)
      collect(json[i], fmt::format("{}[{}]", place, i), numbers);
  }
}

Numbers numbers_of(const Json& results) {
  Numbers numbers;
  for (const auto& [key, value] : results.items())
    if (key != "schema_version" && key != "configuration" && key != "seed") collect(value, key, numbers);
  return numbers;
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

}  // namespace

Table side_by_side(const std::vector<NamedResults>& results) {
  std::vector<std::string> keys;
  std::vector<std::map<std::string, double>> values;
  for (const NamedResults& one : results) {
    values.emplace_back();
    for (const auto& [key, value] : numbers_of(one.json))
      if (values.back().emplace(key, value).second && std::find(keys.begin(), keys.end(), key) == keys.end())
        keys.push_back(key);
  }
  Table table{"side_by_side", "Side by side"};
  table.column({"result", "result"});
  for (const NamedResults& one : results) table.column({one.name, one.name, "{:.6g}"});
  const bool two = results.size() == 2;
  if (two) table.column({"difference [%]", "difference_percent", "{:+.3g}"});
  for (const std::string& key : keys) {
    std::vector<Cell> cells{key};
    std::vector<double> found;
    for (const auto& those : values) {
      const auto at = those.find(key);
      cells.emplace_back(at == those.end() ? std::numeric_limits<double>::quiet_NaN() : at->second);
      if (at != those.end()) found.push_back(at->second);
    }
    if (found.size() < 2 || std::equal(found.begin() + 1, found.end(), found.begin())) continue;
    if (two)
      cells.emplace_back(found[0] == 0.0 ? std::numeric_limits<double>::quiet_NaN()
                                         : 100.0 * (found[1] / found[0] - 1.0));
    table.row(std::move(cells));
  }
  return table;
}

void write_joined_report(const std::vector<fs::path>& folders, const fs::path& file) {
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
  if (const Table table = side_by_side(results); table.rows() > 0)
    sections.insert(sections.begin(), {"Side by side", "<h1>Side by side</h1>\n" + html_table(table)});
  const fs::path partial = file.string() + ".partial-" + std::to_string(getpid());
  write_file(partial, report_page(sections));
  fs::rename(partial, file);
}

}  // namespace beamid::experiments
