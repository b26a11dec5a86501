#include "experiments/results/key_label.hpp"

#include <algorithm>
#include <utility>

namespace beamid::experiments {

std::string key_label(const std::string& key) {
  static const std::pair<const char*, const char*> units[] = {{"_n_s_per_m", "N s/m"},
                                                              {"_n_per_m", "N/m"},
                                                              {"_m_per_s2", "m/s2"},
                                                              {"_m_per_s", "m/s"},
                                                              {"_kg_per_m3", "kg/m3"},
                                                              {"_n_m2", "N m2"},
                                                              {"_kg", "kg"},
                                                              {"_hz", "Hz"},
                                                              {"_pa", "Pa"},
                                                              {"_percent", "%"},
                                                              {"_m", "m"},
                                                              {"_s", "s"},
                                                              {"_n", "N"}};
  std::string text = key, unit = key.ends_with("ratio") ? "-" : "";
  for (const auto& [ending, name] : units)
    if (text.ends_with(ending)) {
      text.resize(text.size() - std::string(ending).size());
      unit = name;
      break;
    }
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '.' || c == '_'; }, ' ');
  return unit.empty() ? text : text + " [" + unit + "]";
}

}  // namespace beamid::experiments
