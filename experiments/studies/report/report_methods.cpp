
#include "experiments/studies/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "experiments/results/gnuplot_axes.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

/// "filter.method" -> "ekf", in the file's order.
using Settings = std::vector<std::pair<std::string, std::string>>;

constexpr std::size_t longest_cell = 60;  // characters of a cell

std::string cell_text_of(const Json& json) {
  std::string text = json.is_string() ? json.get<std::string>() : json.dump();
  if (text.size() <= longest_cell) return text;
  std::size_t end = longest_cell;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // whole letters of UTF-8
  return text.substr(0, end) + "...";
}

void collect(const Json& json, const std::string& place, Settings& settings) {
  const bool tables = json.is_array() &&
                      std::any_of(json.begin(), json.end(), [](const Json& one) { return one.is_object(); });
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      collect(value, place.empty() ? key : place + "." + key, settings);
  } else if (tables) {
    for (std::size_t i = 0; i < json.size(); ++i) {  // an entry by its name, where it has one
      const Json name = json[i].is_object() ? json[i].value("name", Json()) : Json();
      collect(
          json[i],
          fmt::format("{}[{}]", place, name.is_string() ? name.get<std::string>() : std::to_string(i + 1)),
          settings);
    }
  } else {
    settings.emplace_back(place, cell_text_of(json));
  }
}

/// "filter.method", "discretisation"; no entry of an array, as a sensor.
bool names_a_method(const std::string& key) {
  const std::string last = key.substr(key.rfind('.') + 1);
  return key.find('[') == std::string::npos &&
         (last == "name" || last == "method" || last == "discretisation" || last == "estimator");
}

/// Keys of the first column, a column for every run. @param all rows that are the same everywhere too
Table beside_each_other(Table table, const std::vector<NamedResults>& results,
                        const std::vector<Settings>& settings, bool all) {
  std::vector<std::string> keys;
  for (const Settings& those : settings)
    for (const auto& [key, value] : those)
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  table.column({"", "setting"});
  for (const NamedResults& one : results) table.column({one.name, one.name});
  for (const std::string& key : keys) {
    std::vector<Cell> cells{key};
    for (const Settings& those : settings) {
      const auto at =
          std::find_if(those.begin(), those.end(), [&](const auto& one) { return one.first == key; });
      cells.emplace_back(at == those.end() ? std::string("-") : at->second);
    }
    if (all || !std::equal(cells.begin() + 2, cells.end(), cells.begin() + 1)) table.row(std::move(cells));
  }
  return table;
}

}  // namespace

Table configuration_differences(const std::vector<NamedResults>& results) {
  std::vector<Settings> settings(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    collect(results[i].json.value("configuration", Json::object()), "", settings[i]);
    if (results[i].json.contains("seed")) collect(results[i].json["seed"], "seed", settings[i]);
  }
  return beside_each_other({"configuration_differences", "What differs between the configurations"}, results,
                           settings, false);
}

Table run_versions(const std::vector<NamedResults>& results) {
  std::vector<Settings> settings(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    settings[i].emplace_back("command", "beamid " + results[i].json.value("command", ""));
    Settings all;
    collect(results[i].json.value("configuration", Json::object()), "", all);
    std::copy_if(all.begin(), all.end(), std::back_inserter(settings[i]),
                 [](const auto& one) { return names_a_method(one.first); });
    settings[i].emplace_back("beamid", results[i].json.value("version", "-"));
    for (const auto& [library, version] : results[i].made_with.items())
      if (library != "beamid") settings[i].emplace_back(library, cell_text_of(version));
  }
  return beside_each_other({"run_versions", "Commands, methods and versions"}, results, settings, true);
}

std::string methods_html(const std::vector<NamedResults>& results, const std::vector<std::string>& commands) {
  std::string html = "<h1>Methods and versions</h1>\n";
  for (std::size_t i = 0; i < results.size(); ++i)
    if (!commands[i].empty())
      html += "<p><b>" + escaped(results[i].name) + "</b></p>\n<pre>" + escaped(commands[i]) + "</pre>\n";
  return html + html_table(run_versions(results));
}

}  // namespace beamid::experiments
