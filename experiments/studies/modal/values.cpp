#include <cmath>

#include "experiments/studies/modal/report.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json known(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json describe_mode(const ModeEstimate& mode, const Record& record) {
  Json json{{"frequency_hz", mode.pole.frequency_hz()},
            {"frequency_standard_deviation_hz", known(mode.pole.frequency_deviation_hz)},
            {"damping_ratio", mode.pole.damping_ratio()},
            {"damping_ratio_standard_deviation", known(mode.pole.damping_ratio_deviation)},
            {"stable_orders", mode.orders}};
  json["shape"] = Json::array();
  for (Eigen::Index i = 0; i < mode.pole.shape.size(); ++i) {
    json["shape"].push_back({{"channel", record.channels[i].name},
                             {"unit", si_unit(record.channels[i].quantity)},
                             {"amplitude", std::abs(mode.pole.shape[i])},
                             {"phase_rad", std::arg(mode.pole.shape[i])}});
    if (i < mode.pole.shape_deviation.size())
      json["shape"].back()["relative_standard_deviation"] = mode.pole.shape_deviation[i];
  }
  if (mode.pole.shape.size() > 1) json["phase_collinearity"] = phase_collinearity(mode.pole.shape);
  return json;
}

Json describe_mode(const MergedValue& value) {
  return {{"mean", value.mean},
          {"standard_deviation", known(value.deviation)},
          {"standard_deviation_between_records", known(value.scatter)},
          {"records_disagree", value.scattered}};
}

}  // namespace

Json rejected_values(const Stabilisation& stabilisation) {
  Json json = Json::array();
  for (const PoleCluster& cluster : stabilisation.rejected)
    json.push_back({{"frequency_hz", cluster.pole.frequency_hz()},
                    {"damping_ratio", cluster.pole.damping_ratio()},
                    {"stable_orders", cluster.orders},
                    {"reason", cluster.objection}});
  return json;
}

Json values(const std::vector<RecordModes>& records, const std::vector<MergedMode>& merged) {
  Json json;
  json["records"] = Json::array();
  for (const RecordModes& found : records) {
    Json one{{"record", found.name},
             {"samples", found.record.size()},
             {"window_s", {found.record.time[0], found.record.time[found.record.size() - 1]}},
             {"band_hz", {found.band_hz.first, found.band_hz.second}},
             {"sampling_rate_analysed_hz", 1 / found.interval},
             {"free_decay", found.free_decay},
             {"polished", found.polished}};
    one["modes"] = Json::array();
    for (const ModeEstimate& mode : found.modes) one["modes"].push_back(describe_mode(mode, found.record));
    one["rejected"] = rejected_values(found.stabilisation);
    if (found.reproduced.size() > 0) one["response_error_percent"] = 100 * found.left();
    json["records"].push_back(std::move(one));
  }
  if (records.size() < 2) return json;
  json["merged_modes"] = Json::array();
  for (const MergedMode& mode : merged)
    json["merged_modes"].push_back({{"frequency_hz", describe_mode(mode.frequency_hz)},
                                    {"damping_ratio", describe_mode(mode.damping_ratio)},
                                    {"records", mode.records()}});
  return json;
}

Json configuration(const ModalStudySettings& settings, const std::vector<RecordModes>& records) {
  Json json;
  for (const RecordModes& found : records) json["records"].push_back(found.name);
  json["method"]["name"] = settings.method.name;
  const auto options = modal_method_registry().completed(settings.method.name, settings.method.options);
  for (const auto& [name, value] : options.values())
    std::visit([&, key = name](const auto& v) { json["method"][key] = v; }, value);
  if (settings.band_hz) json["band_hz"] = {settings.band_hz->first, settings.band_hz->second};
  json["largest_order"] = settings.largest_order;
  if (settings.modes > 0) json["modes"] = settings.modes;
  json["smallest_amplitude"] = settings.smallest_amplitude;
  const StabilisationSettings& s = settings.stabilisation;
  json["stabilisation"] = {{"frequency_tolerance", s.frequency_tolerance},
                           {"damping_tolerance", s.damping_tolerance},
                           {"assurance_tolerance", s.assurance_tolerance},
                           {"cluster_distance", s.cluster_distance},
                           {"largest_damping_ratio", s.largest_damping_ratio},
                           {"largest_frequency_deviation", s.largest_frequency_deviation},
                           {"fewest_orders", s.fewest_orders}};
  return json;
}

}  // namespace beamid::experiments
