#include "experiments/studies/posterior/report.hpp"

#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {

Results posterior_report(const Experiment& experiment, const PosteriorStudy& study) {
  Results results;
  results.command = "posterior";
  results.seed = study.settings.seed;
  results.configuration = update_configuration(experiment, study.update);
  results.configuration["chains"] = study.settings.chains.chains;
  results.configuration["draws"] = study.settings.chains.draws;
  results.configuration["particles"] = study.settings.particles;
  results.values = posterior_values(study);
  const bool converged = study.posterior.complaints().empty(), explains = study.update.updating.explains();
  if (converged && explains && study.posterior.notable_humps() == 1)
    results.paragraph(posterior_verdict(study));
  else
    results.warning(posterior_verdict(study), !converged);
  if (!explains)
    results.warning(update_verdict(study.update).first +
                    " The posterior takes their standard deviations as they are: it is too narrow.");
  for (const std::string& warning : study.update.warnings) results.warning(warning);
  results.heading("Parameters");
  results.table(posterior_table(study));
  for (const std::string& sentence : posterior_sentences(study)) results.paragraph(sentence);
  if (study.posterior.humps.size() > 1) {
    results.heading("Humps");
    results.table(hump_table(study));
    if (!study.update.deciding.empty()) results.table(deciding_table(study.update.deciding));
  }
  results.heading("Modes");
  results.table(prediction_table(study));
  for (const std::string& remark : study.update.data().remarks) results.paragraph(remark);
  results.figures.push_back(corner_figure(study));
  results.attachments.push_back({{"draws.h5"}, [&study](const std::filesystem::path& folder) {
                                   write_draws(study, folder / "draws.h5");
                                 }});
  results.timing.emplace_back("sampling", study.seconds);
  return results;
}

}  // namespace beamid::experiments
