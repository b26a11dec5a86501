#include "experiments/studies/check/report.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json model_check_values_of(const ModelCheck& check, const Explanation& e) {
  Json json = Json::object();
  for (std::size_t i = 0; i < e.candidates.size(); ++i) {
    const Candidate& c = check.candidates[e.candidates[i]];
    json["changes"].push_back({{"candidate", c.name},
                               {"unit", c.unit == "%" ? "1" : c.unit},
                               {"estimate", e.change[i]},
                               {"standard_deviation", e.determined[i] ? Json(e.deviation[i]) : Json(nullptr)},
                               {"lower_95", e.determined[i] ? Json(e.lower_95(i)) : Json(nullptr)},
                               {"upper_95", e.determined[i] ? Json(e.upper_95(i)) : Json(nullptr)},
                               {"determined", static_cast<bool>(e.determined[i])},
                               {"at_limit", static_cast<bool>(e.at_limit[i])}});
  }
  if (e.candidates.size() > 1) json["correlation"] = e.correlation;
  json["chi_square"] = e.chi_square;
  json["left"] = std::vector<double>(e.left.begin(), e.left.end());
  json["freedom"] = e.freedom;
  json["starts"] = {{"made", e.starts}, {"reached_best", e.reached}};
  json["verdict"] = to_string(e.verdict);
  return json;
}

}  // namespace

void fill_model_check_values(const ModelCheck& check, Results& results) {
  results.configuration["model_error"] = check.settings.model_error;
  results.configuration["shape_error"] = check.settings.shape_error;
  Json& json = results.values;
  json["status"] = check.right ? "agrees" : "differs";
  json["chi_square"] = check.chi_square;
  json["numbers_measured"] = check.numbers;
  for (const CheckedMode& mode : check.modes)
    json["modes"].push_back({{"structure", check.structures[mode.structure].name},
                             {"mode", mode.number},
                             {"predicted_hz", mode.predicted_hz},
                             {"identified_hz", mode.identified.frequency_hz},
                             {"identified_standard_deviation_hz", mode.identified.frequency_deviation_hz},
                             {"predicted_damping_ratio", mode.predicted_damping_ratio},
                             {"damping_ratio", mode.identified.damping_ratio},
                             {"damping_ratio_standard_deviation", mode.identified.damping_ratio_deviation},
                             {"mac", mode.assurance},
                             {"far", mode.far}});
  for (const Candidate& c : check.candidates) {
    Json candidate{{"name", c.name},
                   {"unit", c.unit == "%" ? "1" : c.unit},
                   {"plausible", {c.plausible_lower, c.plausible_upper}}};
    json["candidates"].push_back(candidate);
  }
  for (const Explanation& e : check.single) json["single_changes"].push_back(model_check_values_of(check, e));
  for (const Explanation& e : check.pairs) json["pairs"].push_back(model_check_values_of(check, e));
  json["contradictions"] = check.contradictions;
  json["conclusions"] = conclusions(check);
}

}  // namespace beamid::experiments
