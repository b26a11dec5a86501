#include "experiments/studies/update/report.hpp"

#include <fmt/format.h>

namespace beamid::experiments {
namespace {

constexpr std::size_t most_sets_shown = 6;

std::string starts_text(const UpdateStudy& study) {
  const Updating& updating = study.updating;
  std::string text =
      fmt::format("{} of {} starts reached the first set", updating.best().starts, updating.starts);
  std::size_t others = 0;
  for (const ParameterSet& set : updating.sets)
    if (set.as_well && &set != &updating.best()) others += set.starts;
  if (others > 0) text += fmt::format(", {} another one that fits as well", others);
  if (updating.ended_elsewhere > 0)
    text += fmt::format(", {} ended at a worse one", updating.ended_elsewhere);
  if (updating.failed > 0) text += fmt::format(", {} had no modes", updating.failed);
  return text + ".";
}

}  // namespace

Results report(const Experiment& experiment, const UpdateStudy& study) {
  Results results;
  results.command = "update";
  results.configuration = update_configuration(experiment, study);
  results.values = update_values(study);
  const auto [verdict, good] = update_verdict(study);
  if (good)
    results.paragraph(verdict);
  else
    results.warning(verdict, study.updating.refuted);
  for (const Objection& one : study.objections) results.object(one);
  results.heading("Parameters");
  results.table(parameter_table(study));
  for (const std::string& sentence : update_sentences(study)) results.paragraph(sentence);
  results.paragraph(described_text());
  results.heading("Modes");
  results.table(measured_mode_table(study));
  results.notes(study.data().remarks);
  results.heading("Other sets that fit as well");
  results.paragraph(starts_text(study));
  if (!study.updating.continuum()) results.paragraph(completeness_text(study));
  if (study.updating.sets.size() > 1) results.table(set_table(study, most_sets_shown, true));
  if (study.updating.continuum())
    results.paragraph("Of a continuum of sets that fit as well one is shown.");
  else if (study.updating.as_well() == 1)
    results.paragraph(study.complete() ? "No other set fits as well."
                                       : "No other set was found that fits as well.");
  if (study.updating.as_well() > 1 && !study.deciding.empty()) results.table(deciding_table(study.deciding));
  results.figures.push_back(update_figure(study, "updated_parameters"));
  return results;
}

}  // namespace beamid::experiments
