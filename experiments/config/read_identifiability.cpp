#include "experiments/config/read_identifiability.hpp"

namespace beamid::experiments {

IdentifiabilitySettings read_identifiability(const TomlTable& table) {
  constexpr int most_places = 400, most_sensors = 20;
  IdentifiabilitySettings settings;
  settings.force_measured = table.find_truth("force_measured").value_or(settings.force_measured);
  settings.places = table.find_whole_number("places", 1, most_places).value_or(settings.places);
  settings.more_sensors =
      table.find_whole_number("more_sensors", 0, most_sensors).value_or(settings.more_sensors);
  return settings;
}

}  // namespace beamid::experiments
