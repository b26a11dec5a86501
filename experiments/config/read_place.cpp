#include "experiments/config/read_place.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/useless_keys.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {

std::string expected_place(const fem::Structure& structure) {
  constexpr std::size_t most_shown = 8;
  std::vector<std::string> places = fem::place_names(structure);
  const std::size_t count = places.size();
  places.resize(std::min(count, most_shown));
  return fmt::format("one of the places {}{}", joined(places),
                     count > most_shown ? fmt::format(", ... ({} in all)", count) : "");
}

std::string read_place(const TomlTable& table, const fem::Structure& structure, bool needed,
                       const std::string& at, const std::string& position) {
  if (structure.has_positions()) {
    refuse_useless(table, {at}, std::string("for a ") + structure.kind(), position);
    return {};
  }
  refuse_useless(table, {position}, std::string("for a ") + structure.kind() + ", whose places have names",
                 at + ", " + expected_place(structure));
  const auto name = table.find_text(at);
  if (!name) {
    if (needed) table.miss(at, expected_place(structure));
    return {};
  }
  const std::vector<std::string> places = fem::place_names(structure);
  if (std::find(places.begin(), places.end(), *name) == places.end()) {
    const auto meant = nearest(*name, places);
    table.refuse(at, expected_place(structure) + (meant ? "; did you mean '" + *meant + "'?" : ""));
  }
  return *name;
}

}  // namespace beamid::experiments
