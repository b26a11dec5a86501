#include "experiments/config/read_frequency_response.hpp"

#include <fmt/format.h>

#include "experiments/config/read_attachments.hpp"
#include "experiments/config/useless_keys.hpp"

namespace beamid::experiments {

FrequencyResponseSettings read_frequency_response(const TomlTable& table, double length) {
  using Kind = FrequencyResponseSettings::Kind;
  constexpr int most_points = 1000000, most_modes = 1000;
  FrequencyResponseSettings settings;
  const auto kind = table.find_text("kind", {"receptance", "mobility", "accelerance"});
  for (const Kind each : {Kind::receptance, Kind::mobility, Kind::accelerance})
    if (kind == to_string(each)) settings.kind = each;
  settings.logarithmic = table.find_text("spacing", {"linear", "logarithmic"}) != "linear";
  settings.from_hz = table.find_number("from_hz", settings.logarithmic ? Sign::positive : Sign::not_negative);
  settings.to_hz = table.find_number("to_hz", Sign::positive);
  if (settings.from_hz && settings.to_hz && *settings.from_hz >= *settings.to_hz)
    table.refuse("to_hz", fmt::format("a number above from_hz, {}", *settings.from_hz));
  settings.points = table.find_whole_number("points", 2, most_points).value_or(settings.points);
  for (const TomlTable& pair : table.find_tables("pairs")) {
    PointPair points;
    if (pair.contains("input_m")) points.input = position_on_beam(pair, "input_m", length);
    if (pair.contains("output_m")) points.output = position_on_beam(pair, "output_m", length);
    settings.pairs.push_back(points);
  }
  settings.method.name = table.find_text("method", {"direct", "modal"}).value_or("");
  settings.method.modes = table.find_whole_number("modes", 1, most_modes).value_or(0);
  settings.method.residual_modes = table.find_truth("residual_modes").value_or(true);
  if (settings.method.name == "direct")
    refuse_useless(table, {"modes", "residual_modes"}, "with method = \"direct\"", "method = \"modal\"");
  return settings;
}

}  // namespace beamid::experiments
