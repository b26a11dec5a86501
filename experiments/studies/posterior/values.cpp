#include <cmath>

#include "experiments/config/description.hpp"
#include "experiments/studies/posterior/report.hpp"
#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json draw_values(const DrawSummary& summary) {
  return {{"mean", summary.mean},
          {"median", summary.median},
          {"standard_deviation", summary.deviation},
          {"lower_95", summary.lower_95},
          {"upper_95", summary.upper_95}};
}

Json parameter_values(const PosteriorStudy& study, std::size_t j) {
  const PosteriorParameter& one = study.parameters[j];
  Json json{{"name", study.unknowns()[j].name}, {"unit", study.unknowns()[j].unit}};
  json.update(draw_values(one.all));
  json["laplace_standard_deviation"] = one.laplace.front();
  json["r_hat"] = one.convergence.r_hat;
  json["effective_draws"] = one.convergence.effective_draws;
  json["prior"] = study.likelihood->priors()[j].text();
  json["prior_assumed"] = study.likelihood->priors()[j].assumed();
  json["width_over_prior"] = one.share_of_prior;
  json["piles_up_at_bound"] = one.cut_at ? Json(*one.cut_at) : Json(nullptr);
  json["in_tail_of_prior"] = one.in_tail;
  return json;
}

Json hump_values(const PosteriorStudy& study, std::size_t h) {
  Json json{{"probability", study.posterior.share[h]}, {"share_of_draws", study.posterior.chain_share[h]}};
  const Eigen::VectorXd top = study.likelihood->physical(study.posterior.humps[h].top);
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const DrawSummary& hump = study.parameters[j].humps[h];
    json["parameters"].push_back(
        {{"name", study.unknowns()[j].name},
         {"top", top[static_cast<Eigen::Index>(j)]},
         {"laplace_standard_deviation", study.parameters[j].laplace[h]},
         {"mean", hump.deviation > 0.0 ? Json(hump.mean) : Json(nullptr)},
         {"standard_deviation", hump.deviation > 0.0 ? Json(hump.deviation) : Json(nullptr)}});
  }
  return json;
}

}  // namespace

Json posterior_values(const PosteriorStudy& study) {
  const Posterior& posterior = study.posterior;
  Json json;
  json["verdict"] = posterior_verdict(study);
  json["status"] = !posterior.complaints().empty() ? "not converged"
                   : !study.explains()             ? "not explained"
                   : posterior.notable_humps() > 1 ? "several humps"
                                                   : "one hump";
  json["converged"] = posterior.complaints().empty();
  json["disagrees"] = posterior.disagrees();
  json["contradicted"] = study.contradicted();
  json["reasons"] = posterior.complaints();
  json["log_evidence"] = posterior.log_evidence();
  json["log_evidence_standard_error"] =
      number_or_null(posterior.importance.poor() ? std::nan("") : posterior.importance.standard_error);
  json["log_evidence_tempering"] = posterior.tempered.log_evidence;
  json["importance_effective_share"] = posterior.importance.effective_share;
  json["r_hat"] = posterior.worst_r_hat();
  json["effective_draws"] = posterior.fewest_effective();
  json["divergences"] = posterior.divergences();
  json["log_evidence_temperings_apart"] = posterior.tempered_apart;
  json["tempering_stages"] = posterior.tempered.stages;
  json["likelihood_evaluations"] = posterior.evaluations;
  for (std::size_t j = 0; j < study.unknowns().size(); ++j)
    json["parameters"].push_back(parameter_values(study, j));
  for (std::size_t h = 0; h < posterior.humps.size(); ++h) json["humps"].push_back(hump_values(study, h));
  for (std::size_t i = 0; i < study.predicted.size(); ++i) {
    Json mode{{"measured_hz", study.update->data().modes[i].frequency_hz},
              {"standard_deviation_hz", study.update->residual->frequency_deviation(i)}};
    mode["predicted_hz"] = draw_values(study.predicted[i].drawn);
    mode["mac"] = number_or_null(study.predicted[i].mac);
    json["modes"].push_back(mode);
  }
  json["deciding_measurements"] = Json::array();
  if (posterior.humps.size() > 1 && study.update)
    for (const DecidingMeasurement& one : study.update->deciding)
      json["deciding_measurements"].push_back(
          {{"measurement", deciding_text(one)}, {"least_distance_standard_deviations", one.separation}});
  return json;
}

}  // namespace beamid::experiments
