#include "experiments/studies/twins/report.hpp"

#include <fmt/format.h>

namespace beamid::experiments {
namespace {

constexpr std::size_t most_twins_shown = 12;

// Whether a set that the searches did not find would be no surprise.
bool hardly_searched(const UpdateStudy& study) {
  return study.twins.method != TwinSearch::Method::all_solutions && starts_say_little(study.updating);
}

std::string one_set_text(const UpdateStudy& study) {
  if (hardly_searched(study))
    return fmt::format("One set of parameters explains the modes, as far as so few starts can tell ({}).",
                       study.updating.starts);
  if (study.twins.method == TwinSearch::Method::all_solutions && !study.complete())
    return "One set of parameters explains the modes, as far as was found.";
  return "One set of parameters explains the modes.";
}

std::string twins_verdict(const UpdateStudy& study) {
  const std::size_t sets = study.updating.as_well();
  if (study.updating.refuted) return update_verdict(study).first;
  if (study.updating.continuum())
    return "Not a number of sets but a continuum explains the modes: " + update_verdict(study).first;
  const std::size_t exact = study.twins.values.size();
  std::string text = sets == 1 ? one_set_text(study) : sets_text(study.updating) + ".";
  if (study.twins.method == TwinSearch::Method::all_solutions && exact > sets)
    text += fmt::format(" {} meet the frequencies; shapes, bounds or priors rule out the others.", exact);
  return text;
}

}  // namespace

Results twins_report(const Experiment& experiment, const UpdateStudy& study) {
  Results results;
  results.command = "twins";
  results.configuration = update_configuration(experiment, study);
  results.values = update_values(study);
  results.values["verdict"] = twins_verdict(study);
  const bool good = study.updating.explains() && study.updating.open.empty() &&
                    study.updating.as_well() == 1 && !hardly_searched(study);
  if (good)
    results.paragraph(twins_verdict(study));
  else
    results.warning(twins_verdict(study), study.updating.refuted);
  if (!study.updating.continuum()) results.paragraph(completeness_text(study));
  for (const std::string& warning : study.warnings) results.warning(warning);
  results.table(set_table(study, most_twins_shown,
                          study.updating.explains() && study.twins.values.size() > study.updating.as_well()));
  for (const std::string& sentence : update_sentences(study)) results.paragraph(sentence);
  results.notes(study.data().remarks);
  if (study.updating.as_well() > 1 && !study.deciding.empty()) {
    results.paragraph("Best to tell them apart: " + deciding_text(study.deciding.front()) + ".");
    results.table(deciding_table(study.deciding));
  }
  results.heading("Modes");
  results.table(measured_mode_table(study));
  results.figures.push_back(update_figure(study, "twins"));
  return results;
}

}  // namespace beamid::experiments
