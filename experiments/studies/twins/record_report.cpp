#include "experiments/studies/twins/record_report.hpp"

#include <cmath>

#include <fmt/format.h>

#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {
namespace {

constexpr std::size_t most_twins_shown = 12;

// Whether a set that the searches did not find would be no surprise.
bool hardly_searched(const UpdateStudy& study) {
  return study.twins.method != TwinSearch::Method::all_solutions && starts_say_little(study.updating);
}

std::string one_set_text(const UpdateStudy& study) {
  if (hardly_searched(study))
    return fmt::format("One set of parameters explains the modes, as far as so few starts can show ({}).",
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
  for (const Objection& one : study.objections) results.object(one);
  results.table(set_table(study, most_twins_shown,
                          study.updating.explains() && study.twins.values.size() > study.updating.as_well()));
  for (const std::string& sentence : update_sentences(study)) results.paragraph(sentence);
  results.notes(study.data().remarks);
  if (study.updating.as_well() > 1 && !study.deciding.empty()) {
    results.paragraph("Best to distinguish them: " + deciding_text(study.deciding.front()) + ".");
    results.table(deciding_table(study.deciding));
  }
  results.heading("Modes");
  results.table(measured_mode_table(study));
  results.figures.push_back(update_figure(study, "twins"));
  add_swinging_modes(study, results);
  return results;
}

namespace {

using Eigen::Index;

constexpr std::size_t most_shown = 8;

Table twin_table(const ComparedRun& run, const RecordTwins& twins) {
  const std::size_t shown = std::min(twins.sets.size(), most_shown);
  Table table{"twins", "Other sets of parameters that explain the record as well"};
  table.column({"parameter", "parameter"}).column({"unit", "unit"}).column({"found", "found", "{:.5g}"});
  for (std::size_t s = 0; s < shown; ++s)
    table.column({fmt::format("set {}", s + 2), fmt::format("set_{}", s + 2), "{:.5g}"});
  const auto row = [&](const std::string& name, const std::string& unit, double found, const auto& of) {
    std::vector<Cell> cells{name, unit, found};
    for (std::size_t s = 0; s < shown; ++s) cells.emplace_back(of(twins.sets[s]));
    table.row(std::move(cells));
  };
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const Estimate& e = run.parameters[j].estimate;
    row(e.name, e.unit, e.value, [&](const RecordTwin& twin) { return twin.values[static_cast<Index>(j)]; });
  }
  row("chi^2 more, of the record", "", 0.0, [](const RecordTwin& twin) { return twin.chi_square; });
  row("chi^2 more, beforehand", "", 0.0, [](const RecordTwin& twin) { return twin.prior_chi_square; });
  if (twins.sets.size() > shown)
    table.note = fmt::format("{} more in results.json.", twins.sets.size() - shown);
  return table;
}

}  // namespace

void add_twins(Results& results, const ComparedRun& run, const RecordTwins& twins) {
  if (twins.tried == 0) return;
  auto sets = nlohmann::ordered_json::array();
  for (const RecordTwin& twin : twins.sets) {
    auto values = nlohmann::ordered_json::array();
    for (std::size_t j = 0; j < run.parameters.size(); ++j)
      values.push_back({{"name", run.parameters[j].estimate.name},
                        {"unit", run.parameters[j].estimate.unit},
                        {"value", twin.values[static_cast<Index>(j)]}});
    sets.push_back({{"parameters", values},
                    {"chi_square_more", twin.chi_square},
                    {"prior_chi_square_more", twin.prior_chi_square}});
  }
  results.values["twins"] = {{"tried", twins.tried}, {"sets", sets}};
  if (twins.sets.empty()) {
    results.paragraph(fmt::format(
        "{} other set{} of parameters {} the same frequencies; the record's shapes and forces rule {} out.",
        twins.tried, twins.tried == 1 ? "" : "s", twins.tried == 1 ? "has" : "have",
        twins.tried == 1 ? "it" : "them"));
    return;
  }
  if (twins.undecided() < twins.sets.size())
    results.paragraph(
        "Of the sets below, those with a chi^2 of 6 or more, of the record and beforehand together, are "
        "decidedly less "
        "likely than the one found.");
  results.table(twin_table(run, twins));
  if (!twins.deciding.empty()) {
    results.paragraph("Best to distinguish them: " + deciding_text(twins.deciding.front()) + ".");
    results.table(deciding_table(twins.deciding));
  }
}

}  // namespace beamid::experiments
