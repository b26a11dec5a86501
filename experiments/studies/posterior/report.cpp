#include "experiments/studies/posterior/report.hpp"

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/identify/engine/measured_force.hpp"
#include "experiments/studies/sensing/report.hpp"
#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {
namespace {

void add_mode_warnings(const PosteriorStudy& study, Results& results) {
  if (!study.explains())
    results.warning(update_verdict(*study.update).first +
                    " The posterior takes their standard deviations as they are: it is too narrow.");
  for (const Objection& one : study.update->objections) results.object(one);
}

nlohmann::ordered_json record_configuration(const Experiment& experiment, const PosteriorStudy& study) {
  nlohmann::ordered_json json = describe(experiment);
  json["reduction"] = study.source->sensing.reduction;
  return json;
}

// Frequencies, and motion that no measured force drives, show stiffness over mass alone.
std::string mass_sentence(const Experiment& experiment, const PosteriorStudy& study) {
  for (const ParameterChoice& one : experiment.parameters)
    if (one.quantity.find("mass") != std::string::npos || one.quantity == "factor") return "";
  if (study.source && measures_force(study.source->record.record)) return "";
  return (study.source ? "No force was measured: "
                       : "Frequencies determine the ratio of stiffness to mass alone: ") +
         std::string(of_unweighed_masses);
}

}  // namespace

Results posterior_report(const Experiment& experiment, const PosteriorStudy& study) {
  Results results;
  results.command = "posterior";
  results.seed = study.settings.seed;
  results.configuration = study.update ? update_configuration(experiment, *study.update)
                                       : record_configuration(experiment, study);
  results.configuration["chains"] = study.settings.chains.chains;
  results.configuration["draws"] = study.settings.chains.draws;
  results.configuration["particles"] = study.settings.particles;
  results.values = posterior_values(study);
  if (study.source) results.paragraph(sensing_sentence(study.source->sensing, "The record"));
  const bool converged = study.posterior.complaints().empty();
  if (converged && study.explains() && study.posterior.notable_humps() == 1)
    results.paragraph(posterior_verdict(study));
  else
    results.warning(posterior_verdict(study), study.posterior.disagrees() || study.contradicted());
  if (study.update)
    add_mode_warnings(study, results);
  else
    add_sensing_verdict(study.source->sensing, results);
  for (const Objection& one : prior_objections(study)) results.object(one);
  if (const std::string text = mass_sentence(experiment, study); !text.empty()) results.paragraph(text);
  results.heading("Parameters");
  results.table(posterior_table(study));
  for (const std::string& sentence : posterior_sentences(study)) results.paragraph(sentence);
  if (study.posterior.humps.size() > 1) {
    results.heading("Humps");
    results.table(hump_table(study));
    if (study.update && !study.update->deciding.empty())
      results.table(deciding_table(study.update->deciding));
  }
  if (study.update) {
    results.heading("Modes");
    results.table(prediction_table(study));
    results.notes(study.update->data().remarks);
  }
  results.figures.push_back(corner_figure(study));
  results.attachments.push_back({{"draws.h5"}, [&study](const std::filesystem::path& folder) {
                                   write_draws(study, folder / "draws.h5");
                                 }});
  results.timing.emplace_back("sampling", study.seconds);
  return results;
}

}  // namespace beamid::experiments
