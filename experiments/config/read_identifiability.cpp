#include "experiments/config/read_identifiability.hpp"

#include "experiments/config/key_tables.hpp"

namespace beamid::experiments {

const Schema<IdentifiabilitySettings>& identifiability_keys() {
  using I = IdentifiabilitySettings;
  constexpr int most_places = 400, most_sensors = 20;
  static const Schema<I> keys =
      Schema<I>("identifiability")
          .key("force_measured", &I::force_measured,
               "whether the record holds the exciting forces; without them it begins when the last has ended",
               "false")
          .key("places", &I::places, {1, most_places},
               "parts of the beam between the places to which a sensor is moved, nodes of the mesh at most",
               "20")
          .key("more_sensors", &I::more_sensors, {0, most_sensors},
               "further sensors, added one by one where they tell most", "2");
  return keys;
}

namespace {
const bool identifiability_keys_registered =
    register_keys([]() -> const KeyTable& { return identifiability_keys(); });
}

}  // namespace beamid::experiments
