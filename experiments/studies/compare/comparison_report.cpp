#include "experiments/studies/compare/comparison_report.hpp"

#include <fmt/format.h>

#include "experiments/config/channel_places.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/studies/compare/clock_report.hpp"
#include "experiments/studies/compare/comparison_figures.hpp"
#include "experiments/studies/compare/comparison_tables.hpp"
#include "experiments/studies/compare/comparison_values.hpp"
#include "experiments/studies/compare/comparison_words.hpp"

namespace beamid::experiments {
namespace {

void add_arrays(const Comparison& comparison, Results& results) {
  const bool alone = comparison.runs.size() == 1;
  for (const ComparedRun& run : comparison.runs) {
    if (run.reproduced.size() == 0) continue;
    const std::string name = alone ? "" : name_of(comparison, run);
    results.arrays.push_back({name, "innovations", run.run.innovations});
    results.arrays.push_back({name, "reproduced", run.reproduced});
  }
  results.arrays.push_back({"", "time_s", comparison.compared.record.time.transpose()});
}

}  // namespace

Results report(const Experiment& experiment, const Comparison& comparison) {
  const Record& record = comparison.compared.record;
  Results results;
  results.command = "compare";
  if (comparison.compared.truth) results.seed = comparison.compared.truth->simulation.seed;
  results.configuration = comparison_configuration(experiment, comparison);
  results.values = comparison_values(comparison);
  const std::optional<RecordInputs> inputs = record_inputs(record);
  const char* const usual = comparison.runs.size() == 1 ? "Identification" : "Reduced against continuum";
  results.heading(experiment.title.empty() ? usual : experiment.title);
  for (const std::string& warning : record.warnings) results.warning(warning);
  for (const std::string& warning : comparison.warnings) results.warning(warning);
  const bool alone = comparison.runs.size() == 1;
  // Of a run without an estimate to rely on the first says why.
  const std::size_t failures = alone && !comparison.runs[0].answers() ? 1 : 0;
  std::size_t said = 0;
  for (const std::string& text : said_once(comparison, [](const ComparedRun& run) { return run.warnings; }))
    results.warning(text, said++ < failures);
  if (!reference_run(comparison) && (!alone || said == 0))
    results.warning(
        alone ? fmt::format("{}: {}.", to_string(comparison.runs[0].status), comparison.runs[0].reason)
              : "No run converged.",
        true);
  results.paragraph(
      fmt::format("{}: {} samples from {:.4g} to {:.4g} s at {:.5g} Hz; {}. Model {}, {} pass{}.{}",
                  comparison.compared.name, record.size(), record.time[0], record.time[record.size() - 1],
                  1.0 / record.interval(), channels_text(record), experiment.model.name, experiment.passes,
                  experiment.passes == 1 ? "" : "es", inputs ? " " + words(*inputs) : ""));
  if (alone && comparison.runs[0].has_estimate()) results.table(parameter_table(comparison.runs[0], record));
  results.table(run_table(comparison));
  for (const std::string& name : parameter_names(comparison))
    if (!alone) results.table(parameter_table(comparison, name));
  add_clocks(results, comparison);
  for (const std::string& paragraph : words(comparison)) results.paragraph(paragraph);
  results.notes(comparison.compared.notes);
  results.figures = figures(comparison);
  add_arrays(comparison, results);
  for (const ComparedRun& run : comparison.runs) {
    const std::string name = fmt::format("{} {} {}", run.reduction, run.filter, run.discretisation);
    results.timing.emplace_back(name + " filter", run.seconds);
    results.timing.emplace_back(name + " reproduction_and_bound", run.response_seconds);
  }
  return results;
}

}  // namespace beamid::experiments
