#include "experiments/config/vocabulary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/known_names.hpp"
#include "experiments/config/read_frame.hpp"
#include "experiments/config/read_parameters.hpp"
#include "experiments/config/read_segment.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

struct UnknownKey {
  Place place;
  std::string message;
};

/// @param name the table's, without the number that an element of an array has in its own name.
void collect(const TomlTable& table, const std::string& name, std::vector<UnknownKey>& unknown) {
  const auto known = std::find_if(vocabulary().begin(), vocabulary().end(),
                                  [&](const TableVocabulary& candidate) { return candidate.table == name; });
  if (known == vocabulary().end())
    return;  // the key holds a value by right, and the reader will refuse the table
  for (const std::string& key : table.keys()) {
    if (std::find(known->keys.begin(), known->keys.end(), key) != known->keys.end()) {
      for (const TomlTable& below : table.tables_below(key)) collect(below, table.path(key), unknown);
    } else if (!known->has_options) {
      unknown.push_back(
          {table.key_place(key), fmt::format("unknown key '{}'{}; {}", key, name.empty() ? "" : " in " + name,
                                             known_names(key, known->keys))});
    }
  }
}

std::vector<std::string> beam_keys() {
  std::vector<std::string> keys = segment_keys();
  for (const char* key :
       {"support", "root_rotational_stiffness_n_m_per_rad", "root_translational_stiffness_n_per_m",
        "tip_mass_kg", "tip_rotary_inertia_kg_m2", "tip_eccentricity_m", "sensor_mass_kg", "axial_load_n",
        "mass_model", "elements", "segments", "bodies", "supports", "springs", "dashpots", "absorbers",
        "damages", "added_masses"})
    keys.emplace_back(key);
  return keys;
}

}  // namespace

const std::vector<TableVocabulary>& vocabulary() {
  static const std::vector<TableVocabulary> tables{
      {"",
       {"title",
        "beam",
        "damping",
        "excitation",
        "sensors",
        "acquisition",
        "simulation",
        "frequency_response",
        "record",
        "reduction",
        "reductions",
        "model",
        "parameters",
        "filter",
        "filters",
        "compare",
        "identifiability",
        "prior",
        "noise",
        "frame",
        "sweep"}},
      {"beam", beam_keys()},
      {"beam.segments", segment_keys()},
      {"beam.bodies", {"position_m", "mass_kg", "rotary_inertia_kg_m2", "eccentricity_m"}},
      {"beam.supports", {"position_m", "kind"}},
      {"beam.springs", {"position_m", "translational_n_per_m", "rotational_n_m_per_rad", "cubic_n_per_m3"}},
      {"beam.dashpots",
       {"position_m", "translational_n_s_per_m", "rotational_n_m_s_per_rad", "quadratic_n_s2_per_m2"}},
      {"beam.absorbers", {"position_m", "mass_kg", "stiffness_n_per_m", "damping_n_s_per_m"}},
      {"beam.damages", {"from_m", "to_m", "loss"}},
      {"beam.added_masses", {"from_m", "to_m", "mass_per_length_kg_per_m"}},
      {"damping", {"law", "ratio", "ratios", "anchors", "loss_factor"}},
      {"damping.anchors", {"frequency_hz", "ratio"}},
      {"excitation",
       {"kind", "position_m", "deflection_m", "velocity_m_per_s", "mode", "force_n", "momentum_n_s",
        "duration_s", "amplitude_n", "amplitude_m_per_s2", "frequency_hz", "file"}},
      {"sensors",
       {"name", "position_m", "quantity", "distance_m", "noise_m", "noise_m_per_s", "noise_m_per_s2",
        "noise_m_per_m", "clipping", "resolution", "offset", "drift", "startup", "startup_s", "rattle",
        "rattle_above", "dead"}},
      {"acquisition", {"pretrigger_s", "jitter", "median_shortfall", "gaps", "gap_s", "repeated", "force"}},
      {"simulation",
       {"duration_s", "sampling_rate_hz", "steps_per_sample", "method", "frames", "seed"},
       true},
      {"frequency_response",
       {"from_hz", "to_hz", "points", "spacing", "kind", "method", "modes", "residual_modes", "pairs"}},
      {"frequency_response.pairs", {"input_m", "output_m"}},
      {"record",
       {"file", "reader", "separator", "decimal", "header_lines", "malformed", "stamps", "input",
        "sampling_rate_hz", "window_s", "time", "channels", "prepare"}},
      {"record.time", {"column", "unit"}},
      {"record.prepare", {"step"}, true},
      {"record.channels", {"quantity", "column", "unit", "position_m", "distance_m"}},
      {"reduction", {"method", "shape_file"}, true},
      {"reductions", {"method", "shape_file"}, true},
      {"model", {"name"}, true},
      {"parameters", parameter_keys()},
      {"filter", {"method", "discretisation", "on_failure", "smoother", "estimator"}, true},
      {"filters", {"method"}, true},
      {"compare", {"discretisations", "passes"}},
      {"identifiability", {"force_measured", "places", "more_sensors"}},
      {"prior",
       {"stiffness_n_per_m", "stiffness_deviation_n_per_m", "damping_ratio", "damping_ratio_deviation"}},
      {"noise", {"method", "displacement_m", "velocity_m_per_s", "acceleration_m_per_s2", "strain_m_per_m"}},
      {"sweep", {"vary", "random", "seeds", "seed", "identify"}},
      {"frame", {"elements_per_member", "mass_model", "joints", "members", "supports", "bodies", "springs"}},
      {"frame.joints", {"name", "x_m", "y_m"}},
      {"frame.members", member_keys()},
      {"frame.supports", {"joint", "kind"}},
      {"frame.bodies", {"joint", "mass_kg", "rotary_inertia_kg_m2"}},
      {"frame.springs",
       {"joint", "translational_x_n_per_m", "translational_y_n_per_m", "rotational_n_m_per_rad"}},
  };
  return tables;
}

void refuse_unknown_keys(const TomlTable& root) {
  std::vector<UnknownKey> unknown;
  collect(root, "", unknown);
  if (unknown.empty()) return;
  std::stable_sort(unknown.begin(), unknown.end(),
                   [](const UnknownKey& a, const UnknownKey& b) { return a.place.line < b.place.line; });
  std::string message = unknown.front().message;
  constexpr std::size_t most = 10;
  for (std::size_t i = 1; i < std::min(unknown.size(), most); ++i)
    message.append("\n").append(to_string(unknown[i].place)).append(": ").append(unknown[i].message);
  if (unknown.size() > most) message += fmt::format("\n... and {} more unknown keys", unknown.size() - most);
  throw InputError(unknown.front().place, message);
}

}  // namespace beamid::experiments
