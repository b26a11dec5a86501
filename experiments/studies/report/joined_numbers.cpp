#include "experiments/studies/report/joined_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "experiments/results/key_label.hpp"

namespace beamid::experiments {
namespace {

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

}  // namespace

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

}  // namespace beamid::experiments
