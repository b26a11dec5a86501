#include <cmath>

#include "experiments/config/description.hpp"
#include "experiments/identify/update/mode_pairing.hpp"
#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;
using Json = nlohmann::ordered_json;

Json set_values(const UpdateStudy& study, const ParameterSet& set) {
  Json json;
  for (std::size_t j = 0; j < study.unknowns().size(); ++j)
    json["parameters"][study.unknowns()[j].name] = set.values[static_cast<Index>(j)];
  json["chi_square"] = set.fit.chi_square() < 1e-12 ? 0.0 : set.fit.chi_square();
  json["fits_as_well"] = set.as_well;
  json["starts"] = set.starts;
  return json;
}

Json measured_values(const UpdateStudy& study) {
  Json json = Json::array();
  const auto& value = study.updating.best().fit.value;
  const Eigen::MatrixXd assurance = modal_assurances(study.data(), value.modes);
  for (std::size_t i = 0; i < study.data().modes.size(); ++i) {
    const Index k = value.pairs[i];
    json.push_back({{"mode", k + 1},
                    {"measured_hz", study.data().modes[i].frequency_hz},
                    {"standard_deviation_hz", study.residual->frequency_deviation(i)},
                    {"described_hz", study.described.frequency_hz[k]},
                    {"updated_hz", value.modes.frequency_hz[k]},
                    {"mac", number_or_null(assurance(static_cast<Index>(i), k))}});
  }
  return json;
}

}  // namespace

Json update_configuration(const Experiment& experiment, const UpdateStudy& study) {
  Json json = describe(experiment);
  json["modes_file"] = study.data().source;
  json["model_error"] = study.residual->trust().frequency;
  json["shape_error"] = study.residual->trust().shape;
  json["starts"] = study.updating.starts;
  return json;
}

Json update_values(const UpdateStudy& study) {
  const Updating& updating = study.updating;
  Json json;
  json["verdict"] = update_verdict(study).first;
  json["status"] = updating.refuted         ? "not explained"
                   : !updating.open.empty() ? "not determined"
                   : updating.as_well() > 1 ? "several sets"
                   : !updating.explains()   ? "poorly explained"
                                            : "one set";
  json["chi_square"] = updating.best().fit.chi_square() < 1e-12 ? 0.0 : updating.best().fit.chi_square();
  json["chi_square_limit_95"] = updating.limit;
  json["numbers_fitted"] = updating.independent;
  json["freedom"] = updating.freedom;
  json["intervals_widened_by"] = updating.widening;
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const UpdatedParameter& one = updating.parameters[j];
    json["parameters"].push_back(
        {{"name", study.unknowns()[j].name},
         {"unit", study.unknowns()[j].unit},
         {"described", study.unknowns()[j].guess},
         {"estimate", one.value},
         {"standard_deviation", one.determined ? Json(one.deviation) : Json(nullptr)},
         {"lower_95", one.determined ? Json(one.lower_95) : Json(nullptr)},
         {"upper_95", one.determined ? Json(one.upper_95) : Json(nullptr)},
         {"determined", one.determined},
         {"on_bound", one.on_bound},
         {"ran_away", one.at_search_limit},
         {"prior", static_cast<bool>(study.model->asked().has_prior[j])}});
  }
  json["open_directions"] = Json::array();
  for (const OpenDirection& open : updating.open)
    json["open_directions"].push_back(
        {{"weights", std::vector<double>(open.weights.begin(), open.weights.end())},
         {"standard_deviation", number_or_null(open.deviation)}});
  for (const ParameterSet& set : updating.sets) json["sets"].push_back(set_values(study, set));
  json["sets_that_fit_as_well"] = updating.as_well();
  json["complete"] = study.complete();
  json["completeness"] = completeness_text(study);
  json["starts"] = {{"made", updating.starts},
                    {"reached_best", updating.best().starts},
                    {"ended_at_worse", updating.ended_elsewhere},
                    {"without_modes", updating.failed}};
  json["modes"] = measured_values(study);
  json["deciding_measurements"] = Json::array();
  for (const DecidingMeasurement& one : study.deciding)
    json["deciding_measurements"].push_back({{"kind", to_string(one.kind)},
                                             {"measurement", deciding_text(one)},
                                             {"predicted", one.predicted},
                                             {"least_distance_standard_deviations", one.separation}});
  return json;
}

}  // namespace beamid::experiments
