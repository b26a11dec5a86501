// beamid compare: one record, identified on the continuum and on every reduction of it.
#include <filesystem>

#include "apps/beam_options.hpp"
#include "apps/deliver.hpp"
#include "apps/model_option.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/read_reduction.hpp"
#include "experiments/identify/compare/chosen_channels.hpp"
#include "experiments/identify/compare/comparison.hpp"
#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/studies/compare/comparison_report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/text/choice_text.hpp"
#include "filters/filter.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

std::vector<std::string> words_of(const options::variables_map& values, const char* option) {
  return values.count(option) ? values[option].as<std::vector<std::string>>() : std::vector<std::string>();
}

/// What the command line says replaces what the file says; where neither does, the continuum stands beside
/// its smallest reductions.
void complete(const options::variables_map& values, Experiment& experiment) {
  const auto reductions = words_of(values, "reduction");
  if (!reductions.empty()) experiment.reductions.clear();
  for (const std::string& text : reductions)
    experiment.reductions.push_back(parse_reduction(text, "--reduction"));
  if (experiment.reductions.empty())
    for (const char* text : {"none", "rayleigh", "modal_truncation", "modal_truncation:modes=3"})
      experiment.reductions.push_back(parse_reduction(text, "default reductions"));
  const auto chosen = words_of(values, "filter");
  if (!chosen.empty()) experiment.filters.clear();
  for (const std::string& text : chosen)
    experiment.filters.push_back(parse_choice(text, "--filter", filters::filter_registry()));
  if (experiment.filters.empty()) experiment.filters = {experiment.filter};
  const auto discretisations = words_of(values, "discretisation");
  if (!discretisations.empty()) experiment.discretisations = discretisations;
  if (experiment.discretisations.empty()) experiment.discretisations = {experiment.discretisation};
  choose_model(values, experiment);
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  using Words = std::vector<std::string>;
  options::options_description described("Options");
  described.add_options()  //
      ("truth", options::value<std::string>()->value_name("FILE"),
       "experiment file of the beam that a record is simulated from; without it and without RECORD the beam "
       "as described")  //
      ("channel", options::value<Words>()->value_name("NAME"),
       "hear this channel of the record; repeat for more; without it all")  //
      ("reduction", options::value<Words>()->value_name("NAME[:OPTION=VALUE,...]"),
       "compare this one; repeat for more")                                                   //
      ("filter", options::value<Words>()->value_name("NAME[:OPTION=VALUE,...]"), "likewise")  //
      ("discretisation", options::value<Words>()->value_name("NAME"), "likewise")             //
      ("model", options::value<std::string>()->value_name("NAME"), "what is asked: beamid list models");
  described.add(beam_options()).add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {"record"}, values)) return 0;
  if (values.count("record") && values.count("truth"))
    throw UsageError("compare: RECORD and --truth exclude each other; expected one of them");
  BeamSource source = read_beam(command, values);
  complete(values, source.experiment);
  const fs::path folder = source.config.parent_path();
  std::optional<fs::path> file;
  if (values.count("record")) file = fs::path(values["record"].as<std::string>());
  if (!file && !values.count("truth") && source.experiment.record_file)
    file = folder / *source.experiment.record_file;
  deliver(values, [&] {
    return blame_config(source, [&] {
      const Progress progress = show_progress();
      ComparedRecord compared;
      PreparedRecord prepared;
      if (file) {
        prepared = read_and_prepare(*file, source.experiment.format);
        compared = measured_record(file->filename().string(), prepared.record);
        prepared.record = compared.record;
      } else if (values.count("truth")) {
        const fs::path truth = values["truth"].as<std::string>();
        compared = simulated_record(read_experiment(truth), truth.parent_path(), progress);
        compared.name = "simulated from " + truth.filename().string();
      } else {
        compared = simulated_record(source.experiment, folder, progress);
      }
      if (values.count("channel"))
        compared = chosen_channels(std::move(compared), words_of(values, "channel"));
      Results results =
          report(source.experiment, compare(source.experiment, std::move(compared), folder, progress));
      if (file) tell_preparation(results, prepared, source.experiment.format);
      return results;
    });
  });
  return 0;
}

}  // namespace

Command compare_command() {
  return {"compare", "[RECORD | --truth FILE] [--config FILE] [--reduction NAME]... [--out DIR]",
          "one record identified on the continuum and on reductions of it: what each costs and saves",
          "  beamid compare --config cantilever.toml --out results\n"
          "  beamid compare tip.csv --config cantilever.toml --reduction none --reduction rayleigh\n"
          "  beamid compare --config believed.toml --truth damaged.toml --filter ekf --filter ukf\n",
          run};
}

}  // namespace beamid::apps
