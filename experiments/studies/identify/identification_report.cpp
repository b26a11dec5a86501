#include "experiments/studies/identify/identification_report.hpp"

#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/run_diagnostics.hpp"
#include "experiments/studies/compare/comparison_report.hpp"
#include "experiments/studies/identify/diagnostics_report.hpp"
#include "experiments/studies/identify/smoothed_history.hpp"

namespace beamid::experiments {
namespace {

Table batch_table(const ComparedRun& run) {
  Table table{"batch", "Batch estimate: output-error maximum likelihood of all samples at once, no prior"};
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"estimate", "estimate", "{:.6g}"})
      .column({"95 % from", "lower_95", "{:.6g}"})
      .column({"to", "upper_95", "{:.6g}"})
      .column({"filter's", "filter_estimate", "{:.6g}"});
  for (std::size_t j = 0; j < run.batch->parameters.size(); ++j) {
    const Estimate& e = run.batch->parameters[j];
    table.row({e.name, e.unit, e.value, e.lower_95, e.upper_95, run.parameters[j].estimate.value});
  }
  table.note = "Its intervals take the noise as white.";
  if (run.batch->estimate.status != filters::BatchStatus::converged)
    table.note += " It did not converge: " + run.batch->estimate.reason + ".";
  return table;
}

}  // namespace

Results identification_report(const Experiment& experiment, const Comparison& found) {
  const ComparedRun& run = found.runs.at(0);
  const Record& record = found.analysis.record;
  Results results = report(experiment, found);
  results.command = "identify";
  std::vector<std::string> outputs;
  for (const Eigen::Index i : output_channels(record))
    outputs.push_back(record.channels[static_cast<std::size_t>(i)].name);
  if (const std::string text = failure_sentences(run.run.events); !text.empty())
    results.paragraph("The filter had trouble (--on-failure says what it then does). " + text);
  if (run.batch) results.table(batch_table(run));
  if (run.diagnostics) {
    results.paragraph(words(*run.diagnostics, outputs));
    for (Figure& figure : figures(*run.diagnostics, outputs)) results.figures.push_back(std::move(figure));
  }
  if (run.smoothed.empty()) return results;
  const SmoothedRecord smoothed{record.time, *run.model, run.run.filtered, run.smoothed};
  results.figures.push_back(
      smoothed_figure(smoothed, run.frequency_hz.value_or(found.analysis.beam_frequency_hz)));
  results.attachments.push_back(smoothed_history(smoothed));
  return results;
}

}  // namespace beamid::experiments
