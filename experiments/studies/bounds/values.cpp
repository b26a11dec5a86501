#include <cmath>

#include "experiments/config/description.hpp"
#include "experiments/studies/bounds/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;
using Json = nlohmann::ordered_json;

Json numbers(const Eigen::VectorXd& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(number_or_null(value));
  return json;
}

Json values(const ParameterBound& p) {
  return {{"unit", p.unit},
          {"value", p.value},
          {"verdict", to_string(p.verdict)},
          {"known_beforehand", p.nuisance},
          {"prior_deviation", p.nuisance ? Json(p.prior_deviation) : Json(nullptr)},
          {"bound", number_or_null(p.bound)},
          {"bound_percent", number_or_null(p.bound_percent())},
          {"percent_of", p.of_value ? "value" : "deviation"},
          {"conditional_bound", number_or_null(p.conditional_bound)},
          {"conditional_bound_percent", number_or_null(p.conditional_percent())},
          {"lower_95", number_or_null(p.lower_95)},
          {"upper_95", number_or_null(p.upper_95)}};
}

Json combinations(const Identifiability& found) {
  Json json{{"determined", Json::array()}, {"silent", Json::array()}};
  const auto weights = [&](const Eigen::VectorXd& weight) {
    Json named = Json::object();
    for (std::size_t j = 0; j < found.parameters.size(); ++j)
      named[found.parameters[j].name] = weight[static_cast<Index>(j)];
    return named;
  };
  for (Index k = 0; k < found.report.rank; ++k)
    json["determined"].push_back({{"deviation_percent", 100.0 / std::sqrt(found.report.eigenvalues[k])},
                                  {"weights", weights(found.report.combinations.col(k))}});
  const Eigen::MatrixXd silent = silent_combinations(found.report);
  for (const auto& change : silent.colwise()) json["silent"].push_back(weights(change));
  return json;
}

Json values(const Identifiability& found, const BoundSweep& sweep, const char* key, const char* beside = "") {
  Json json{{key, numbers(sweep.at)}, {"bound_percent", Json::object()}};
  for (std::size_t j = 0; j < found.parameters.size(); ++j)
    json["bound_percent"][found.parameters[j].name] = numbers(sweep.percent.col(static_cast<Index>(j)));
  if (sweep.beside.size() > 0) json[beside] = numbers(sweep.beside);
  return json;
}

}  // namespace

Json values(const Identifiability& found) {
  Json json{{"model", found.model},
            {"reduction", found.reduction},
            {"coordinates", found.coordinates},
            {"frequencies_hz", found.frequencies_hz},
            {"time_constant_s", found.slowest_decay > 0.0 ? Json(found.slowest_decay) : Json(nullptr)},
            {"force_measured", found.force_measured},
            {"begin_s", found.begin},
            {"duration_s", found.duration},
            {"sampling_rate_hz", found.sampling_rate},
            {"sensors", Json::array()},
            {"parameters", Json::object()}};
  if (found.inputs) json["inputs_between_samples"] = to_string(found.inputs->path);
  for (const Identifiability::UsedSensor& used : found.sensors)
    json["sensors"].push_back(
        {{"name", used.sensor.name},
         {"quantity", to_string(used.sensor.quantity)},
         {"position_m", used.sensor.place.empty() ? Json(used.sensor.position.value_or(0.0)) : Json(nullptr)},
         {"noise_si", used.sensor.noise},
         {"noise_assumed", used.assumed}});
  for (const ParameterBound& p : found.parameters) json["parameters"][p.name] = values(p);
  json["rank"] = found.report.rank;
  json["condition"] = number_or_null(found.report.condition);
  json["combinations"] = combinations(found);
  json["correlations"] = Json::array();
  for (const auto& row : found.report.correlations.rowwise())
    json["correlations"].push_back(numbers(row.transpose()));
  json["record_length"] = values(found, found.lengths, "duration_s");
  json["sampling_rate"] = values(found, found.rates, "sampling_rate_hz", "modes_below_half");
  if (!found.places.empty()) json["sensor_place"] = values(found, found.places, "position_m");
  if (!found.numbers.empty()) json["sensor_number"] = values(found, found.numbers, "sensors", "added_at_m");
  return json;
}

}  // namespace beamid::experiments
