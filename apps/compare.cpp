// beamid compare: one record, identified on the continuum and on every reduction of it.
#include <filesystem>

#include "apps/beam_options.hpp"
#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/identification_request.hpp"
#include "experiments/studies/compare/report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/text/choice.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

/// What the command line says replaces what the file says; where neither does, the continuum stands beside
/// its smallest reductions.
void complete_compare(const Values& values, Experiment& experiment) {
  const Words reductions = values.texts("reduction");
  if (!reductions.empty()) experiment.reductions.clear();
  for (const std::string& text : reductions)
    experiment.reductions.push_back(parse_reduction(text, "--reduction"));
  if (experiment.reductions.empty() && !experiment.storey_springs.empty())  // which are not reduced
    experiment.reductions = {experiment.reduction};
  if (experiment.reductions.empty())
    for (const char* text : {"none", "rayleigh", "modal_truncation", "modal_truncation:modes=3"})
      experiment.reductions.push_back(parse_reduction(text, "default reductions"));
  const Words chosen = values.texts("filter");
  if (!chosen.empty()) experiment.filters.clear();
  for (const std::string& text : chosen)
    experiment.filters.push_back(parse_choice(text, "--filter", filters::filter_registry()));
  if (experiment.filters.empty()) experiment.filters = {experiment.filter};
  const Words discretisations = values.texts("discretisation");
  for (const std::string& name : discretisations)
    at_place({"--discretisation"}, [&] { filters::scheme_registry().find(name); });
  if (!discretisations.empty()) experiment.discretisations = discretisations;
  if (experiment.discretisations.empty()) experiment.discretisations = {experiment.discretisation};
  choose_model(values, experiment);
}

OptionGroup compare_options() {
  return {
      "Options",
      {text("truth", "FILE",
            "experiment file of the beam that a record is simulated from; without it and without RECORD the "
            "beam as described"),
       text("channel", "NAME", "use this channel of the record; without it all").repeated(),
       reduction_option("a reduction to compare").repeated(), filter_option("a filter to compare").repeated(),
       discretisation_option("a discretisation to compare").repeated(), model_option()}};
}

int run_compare(const Values& values) {
  if (values.has("record") && values.has("truth"))
    throw UsageError("RECORD and --truth exclude each other; expected one of them");
  BeamSource source = read_beam(values);
  complete_compare(values, source.experiment);
  const fs::path folder = source.config.parent_path();
  std::vector<fs::path> file;
  if (!values.has("truth"))
    file = record_files(values, source.config, source.experiment.record_file, source.experiment.format);
  return deliver(values, [&] {
    return blame_config(source, [&] {
      const Progress progress = show_progress(values);
      ComparedRecord compared;
      PreparedRecord prepared;
      std::vector<std::string> decisions;
      if (!file.empty()) {
        IdentificationRequest request{file[0], source.experiment, {}, {}};
        request.prepared = read_and_prepare(file[0], source.experiment.format);
        cut_decay(request);
        keep_out_higher_modes(request, source.experiment.reductions);  // as identify would
        source.experiment.format = request.experiment.format;
        prepared = request.as_analysed();
        decisions = request.decisions();
        compared = request.compared();
      } else if (values.has("truth")) {
        const fs::path truth = values.text("truth");
        compared = simulated_record(read_experiment(truth), truth.parent_path(), progress);
        compared.name = "simulated from " + truth.filename().string();
      } else {
        compared = simulated_record(source.experiment, folder, progress);
      }
      if (values.has("channel")) compared = chosen_channels(std::move(compared), values.texts("channel"));
      Results results =
          report(source.experiment, compare(source.experiment, std::move(compared), folder, progress));
      for (const std::string& text : decisions) results.paragraph(text);
      if (!file.empty()) add_preparation(results, prepared, source.experiment.format);
      return results;
    });
  });
}

}  // namespace

Command compare_command() {
  return {"compare",
          "[RECORD | --truth FILE] [--config FILE] [--reduction NAME]... [--out DIR]",
          "one record identified on the mesh and on reductions of it: bias, interval and time of each",
          {record_argument()},
          {compare_options(), beam_options(), column_options(), output_options()},
          "  beamid compare --config cantilever.toml --out results\n"
          "  beamid compare tip.csv --config cantilever.toml --reduction none --reduction rayleigh\n"
          "  beamid compare --config described.toml --truth damaged.toml --filter ekf --filter ukf\n",
          run_compare,
          "",
          "3  no run has an estimate to rely on, and \"status\" in results.json states why: the first one "
          "\"diverged\" "
          "or is \"contradicted\".\n"};
}

}  // namespace beamid::apps
