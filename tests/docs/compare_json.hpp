// Two results.json: which values differ by more than rounding, each with its path.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tests/docs/compare_numbers.hpp"

namespace beamid::docs {

using nlohmann::json;

/// Where numbers may differ by more than rounding, and why.
struct Looser {
  std::regex
      path;  ///< of the value, as /runs/0/parameters/0/estimate, or the line of a text; found anywhere in it
  Tolerance tolerance;
  bool ignored = false;  ///< neither is compared
  double digits = 1;     ///< in a text, in units of the last digit printed
};

class JsonComparison {
 public:
  explicit JsonComparison(std::vector<Looser> looser) : looser_(std::move(looser)) {}

  /// "/path: golden ..., found ..." for every difference.
  std::vector<std::string> operator()(const json& golden, const json& found) {
    differences_.clear();
    compare(golden, found, "");
    return differences_;
  }

 private:
  void differ(const std::string& path, const std::string& golden, const std::string& found) {
    differences_.push_back(path + ": golden " + golden + ", found " + found);
  }

  Looser looser_at(const std::string& path) const {
    for (const Looser& one : looser_)
      if (std::regex_search(path, one.path)) return one;
    return {};
  }

  void compare(const json& golden, const json& found, const std::string& path) {
    const Looser here = looser_at(path);
    if (here.ignored) return;
    if (golden.is_number() && found.is_number()) {
      const double first = golden.get<double>(), second = found.get<double>();
      const bool counts = golden.is_number_integer() && found.is_number_integer();
      const Tolerance allowed = here.tolerance;
      if (!(counts && allowed.relative == Tolerance{}.relative ? first == second
                                                               : allowed.holds(first, second)))
        differ(path, golden.dump(), found.dump());
    } else if (golden.is_object() && found.is_object()) {
      for (const auto& [key, value] : golden.items())
        if (found.contains(key))
          compare(value, found.at(key), path + "/" + key);
        else
          differ(path + "/" + key, shortened(value), "nothing");
      for (const auto& [key, value] : found.items())
        if (!golden.contains(key)) differ(path + "/" + key, "nothing", shortened(value));
    } else if (golden.is_array() && found.is_array()) {
      if (golden.size() != found.size())
        differ(path, fmt::format("{} items", golden.size()), fmt::format("{} items", found.size()));
      for (std::size_t i = 0; i < std::min(golden.size(), found.size()); ++i)
        compare(golden[i], found[i], fmt::format("{}/{}", path, i));
    } else if (golden.is_string() && found.is_string()) {  // a message may hold numbers
      if (!same_line(golden.get<std::string>(), found.get<std::string>(), 1, here.tolerance))
        differ(path, golden.dump(), found.dump());
    } else if (golden != found) {
      differ(path, shortened(golden), shortened(found));
    }
  }

  static std::string shortened(const json& value) {
    const std::string text = value.dump();
    return text.size() < 100 ? text : text.substr(0, 97) + "...";
  }

  std::vector<Looser> looser_;
  std::vector<std::string> differences_;
};

/// With real numbers to nine significant digits, which is more than is compared and less than differs
/// from machine to machine.
inline json rounded(json value) {
  if (value.is_number_float() && std::isfinite(value.get<double>()))
    value = std::stod(fmt::format("{:.9g}", value.get<double>()));
  else if (value.is_structured())
    for (json& part : value) part = rounded(part);
  return value;
}

}  // namespace beamid::docs
