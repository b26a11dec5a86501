#include "experiments/input/vocabulary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/input/spelling.hpp"

namespace beamid::experiments {
namespace {

struct Unknown {
  Place place;
  std::string message;
};

/// @param name the table's, without the number that an element of an array has in its own name.
void collect(const TomlTable& table, const std::string& name, std::vector<Unknown>& unknown) {
  const auto known = std::find_if(vocabulary().begin(), vocabulary().end(),
                                  [&](const TableVocabulary& candidate) { return candidate.table == name; });
  if (known == vocabulary().end())
    return;  // the key holds a value by right, and the reader will refuse the table
  for (const std::string& key : table.keys()) {
    if (std::find(known->keys.begin(), known->keys.end(), key) != known->keys.end()) {
      for (const TomlTable& below : table.tables_below(key)) collect(below, table.path(key), unknown);
    } else if (!known->has_options) {
      const auto meant = nearest(key, known->keys);
      unknown.push_back(
          {table.key_place(key),
           fmt::format("unknown key '{}'{};{} known: {}", key, name.empty() ? "" : " in " + name,
                       meant ? " did you mean '" + *meant + "'?" : "", joined(known->keys))});
    }
  }
}

}  // namespace

const std::vector<TableVocabulary>& vocabulary() {
  static const std::vector<TableVocabulary> tables{
      {"", {"title", "beam", "record", "reduction", "model", "filter", "prior", "noise"}},
      {"beam",
       {"length_m", "width_m", "height_m", "youngs_modulus_pa", "bending_stiffness_n_m2", "mass_kg",
        "mass_per_length_kg_per_m", "density_kg_per_m3", "tip_mass_kg", "tip_rotary_inertia_kg_m2",
        "sensor_mass_kg", "elements"}},
      {"record", {"file", "separator", "header_lines", "sampling_rate_hz", "window_s", "time", "channels"}},
      {"record.time", {"column", "unit"}},
      {"record.channels", {"quantity", "column", "unit"}},
      {"reduction", {"method"}, true},
      {"model", {"name"}, true},
      {"filter", {"method", "discretisation"}, true},
      {"prior",
       {"stiffness_n_per_m", "stiffness_deviation_n_per_m", "damping_ratio", "damping_ratio_deviation"}},
      {"noise", {"displacement_m", "velocity_m_per_s", "acceleration_m_per_s2"}},
  };
  return tables;
}

void refuse_unknown_keys(const TomlTable& root) {
  std::vector<Unknown> unknown;
  collect(root, "", unknown);
  if (unknown.empty()) return;
  std::stable_sort(unknown.begin(), unknown.end(),
                   [](const Unknown& a, const Unknown& b) { return a.place.line < b.place.line; });
  std::string message = unknown.front().message;
  for (std::size_t i = 1; i < unknown.size(); ++i)
    message.append("\n").append(to_string(unknown[i].place)).append(": ").append(unknown[i].message);
  throw InputError(unknown.front().place, message);
}

}  // namespace beamid::experiments
