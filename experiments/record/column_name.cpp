#include "experiments/record/column_name.hpp"

#include <algorithm>

#include "experiments/record/units.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

/// @param start "acceleration"; @param known its units.
std::optional<ColumnMeaning> parse_as(std::string_view name, std::string_view start,
                                      const std::vector<Unit>& known) {
  if (!name.starts_with(start)) return std::nullopt;
  name.remove_prefix(start.size());
  for (const Unit& unit : known) {
    const std::string end = "_" + unit.suffix;
    if (!name.ends_with(end)) continue;
    name.remove_suffix(end.size());
    if (!name.empty() && (name.front() != '_' || name.size() == 1)) return std::nullopt;
    return ColumnMeaning{std::nullopt, std::string(name.empty() ? name : name.substr(1)), unit.factor};
  }
  return std::nullopt;
}

/// The channel's name as a label: "Tip acceleration, x" -> "tip_x".
std::string label(const Channel& channel) {
  if (const auto meaning = parse_column_name(channel.name)) return meaning->label;
  std::string words;
  for (const char letter : channel.name) {
    const bool lower = letter >= 'a' && letter <= 'z', upper = letter >= 'A' && letter <= 'Z';
    const bool digit = letter >= '0' && letter <= '9';
    if (lower || upper || digit)
      words += upper ? static_cast<char>(letter - 'A' + 'a') : letter;
    else if (!words.empty() && words.back() != '_')
      words += '_';
  }
  const std::string quantity = to_string(channel.quantity);
  if (const std::size_t at = words.find(quantity); at != std::string::npos) words.erase(at, quantity.size());
  words.erase(std::unique(words.begin(), words.end(), [](char a, char b) { return a == '_' && b == '_'; }),
              words.end());
  if (!words.empty() && words.front() == '_') words.erase(0, 1);
  if (!words.empty() && words.back() == '_') words.pop_back();
  return words;
}

}  // namespace

std::optional<ColumnMeaning> parse_column_name(std::string_view name) {
  for (const char* start : {"time", "t"})
    if (auto time = parse_as(name, start, time_units()); time && time->label.empty()) return time;
  for (const Quantity quantity : all_quantities)
    if (auto meaning = parse_as(name, to_string(quantity), units(quantity))) {
      meaning->quantity = quantity;
      return meaning;
    }
  return std::nullopt;
}

std::vector<std::string> column_names(const Record& record) {
  std::vector<std::string> names{"time_s"};
  for (const Channel& channel : record.channels) {
    const std::string middle = label(channel), start = to_string(channel.quantity);
    const std::string end = "_" + units(channel.quantity).front().suffix;
    std::string name = start + (middle.empty() ? "" : "_" + middle) + end;
    for (int copy = 2; std::find(names.begin(), names.end(), name) != names.end(); ++copy)
      name = start + (middle.empty() ? "" : "_" + middle) + "_" + std::to_string(copy) + end;
    names.push_back(std::move(name));
  }
  return names;
}

std::string quantity_key(Quantity quantity) {
  return std::string(to_string(quantity)) + "_" + units(quantity).front().suffix;
}

std::string known_column_names() {
  std::vector<std::string> names;
  for (const Unit& unit : time_units()) names.push_back("time_" + unit.suffix);
  for (const Quantity quantity : all_quantities)
    for (const Unit& unit : units(quantity))
      names.push_back(std::string(to_string(quantity)) + "_" + unit.suffix);
  return joined(names);
}

}  // namespace beamid::experiments
