#include "experiments/config/key_json.hpp"

namespace beamid::experiments {

nlohmann::ordered_json to_json(const std::vector<std::pair<std::string, KeyValue>>& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [key, value] : values)
    std::visit(
        [&, name = key](const auto& held) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(held)>, std::monostate>) json[name] = held;
        },
        value);
  return json;
}

}  // namespace beamid::experiments
