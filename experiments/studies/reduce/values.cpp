#include "experiments/config/description.hpp"
#include "experiments/studies/reduce/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;
using Json = nlohmann::ordered_json;

Json percent_json(double relative) {
  return number_or_null(100.0 * relative);
}

Json modes_of(const ReductionComparison& all, const ComparedReduction& one) {
  Json modes = Json::array();
  for (Index i = 0; i < all.compared(); ++i)
    modes.push_back({{"mode", all.modes.modes.rigid + i + 1},
                     {"frequency_hz", number_or_null(one.frequency_hz[i])},
                     {"frequency_error_percent", percent_json(one.frequency_error[i])},
                     {"mac", number_or_null(one.mac[i])},
                     {"mac_of_deflections", number_or_null(one.deflection_mac[i])}});
  return modes;
}

Json significance_of(const ComparedReduction& one) {
  return {{"what", one.significance_name},
          {"values", std::vector<double>(one.significance.begin(), one.significance.end())}};
}

Json reduction_of(const ReductionComparison& all, const ComparedReduction& one) {
  Json json{{"name", one.label}, {"method", one.choice.name}, {"options", Json::object()}};
  for (const auto& [name, value] : one.choice.options.values())
    std::visit([&json, &name = name](const auto& held) { json["options"][name] = held; }, value);
  if (!one.choice.shape_file.empty()) json["shape_file"] = one.choice.shape_file;
  json["size"] = one.size;
  json["basis_numbers"] = one.identity ? Json(nullptr) : Json(one.size * all.system.size());
  json["modes"] = modes_of(all, one);
  const LowestComac lowest = lowest_comac(one.comac);
  json["lowest_comac"] = number_or_null(lowest.value);
  json["lowest_comac_m"] = lowest.point < 0 ? Json(nullptr) : Json(all.system.node_positions()[lowest.point]);
  json["static_stiffness_n_per_m"] = number_or_null(one.behaviour.static_stiffness);
  json["static_stiffness_error_percent"] = percent_json(one.static_stiffness_error);
  json["modal_mass_kg"] = number_or_null(one.behaviour.modal_mass);
  json["modal_mass_error_percent"] = percent_json(one.modal_mass_error);
  if (one.size == 1) {
    json["equivalent_stiffness_n_per_m"] = json["static_stiffness_n_per_m"];
    json["equivalent_mass_kg"] = json["modal_mass_kg"];
  }
  json["frequency_response_error_percent"] = percent_json(one.response_error);
  json["frequency_response_worst_db"] = number_or_null(one.worst_response);
  json["frequency_response_worst_hz"] = number_or_null(one.worst_response_hz);
  json["decay_displacement_error_percent"] = percent_json(one.displacement_error);
  json["decay_acceleration_error_percent"] = percent_json(one.acceleration_error);
  if (one.significance.size() > 0) json["significance"] = significance_of(one);
  return json;
}

}  // namespace

Json values(const ReductionComparison& all) {
  const ReleaseTest& release = all.release;
  Json json{{"elements", all.system.mesh.elements.size()},
            {"degrees_of_freedom", all.system.size()},
            {"observed_point", {{"name", all.observed.name}, {"position_m", all.observed.position}}},
            {"damping_assumed", all.damping_assumed},
            {"frequency_response",
             {{"from_hz", all.frequency_hz[0]}, {"to_hz", all.frequency_hz[all.frequency_hz.size() - 1]}}},
            {"decay", nullptr}};
  if (release.samples > 0)
    json["decay"] = {{"position_m", release.point.position},
                     {"deflection_m", release.deflection},
                     {"sampling_rate_hz", release.sampling_rate_hz},
                     {"duration_s", release.time()[release.samples - 1]},
                     {"modes_below_hz", release.limit_hz()}};
  json["mesh"] = {{"modes", Json::array()},
                  {"static_stiffness_n_per_m", number_or_null(all.behaviour.static_stiffness)},
                  {"modal_mass_kg", number_or_null(all.behaviour.modal_mass)}};
  for (Index i = 0; i < all.compared(); ++i)
    json["mesh"]["modes"].push_back(
        {{"mode", all.modes.modes.rigid + i + 1}, {"frequency_hz", all.mode_hz(i)}});
  json["reductions"] = Json::array();
  for (const ComparedReduction& one : all.reductions) json["reductions"].push_back(reduction_of(all, one));
  return json;
}

}  // namespace beamid::experiments
