// beamid identify: a real record in, stiffness and damping with intervals out.
#include <algorithm>
#include <filesystem>

#include "apps/deliver.hpp"
#include "experiments/damping_law/damping_law.hpp"
#include "experiments/diagnostics_report.hpp"
#include "experiments/failure_response.hpp"
#include "experiments/input/read_experiment.hpp"
#include "experiments/input/spelling.hpp"
#include "experiments/model_setting.hpp"
#include "experiments/preparation/preparation_report.hpp"
#include "experiments/record_comparison/comparison.hpp"
#include "experiments/record_identification/higher_modes.hpp"
#include "experiments/record_identification/noise_source.hpp"
#include "experiments/record_identification/record_identification.hpp"
#include "filters/smoother.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

constexpr const char* higher_modes =
    "Higher modes are a large part of this record. A filter of one mode would take them for white noise: the "
    "record was low-passed and decimated first, which changes neither frequency nor damping. Any "
    "[[record.prepare]] of the experiment file takes the place of this.";
constexpr const char* trouble = "The filter had trouble (--on-failure says what it then does). ";

/// K and C of a free decay have a report of their own; any other model is a comparison of one run.
bool is_free_oscillator(const Experiment& experiment, const Record& record) {
  return experiment.model.name == "sdof" && experiment.parameters.empty() && force_channels(record).empty();
}

Results identify_generally(Experiment experiment, const Record& record, const fs::path& file,
                           const fs::path& folder) {
  experiment.reductions = {experiment.reduction};
  experiment.filters = {experiment.filter};
  experiment.discretisations = {experiment.discretisation};
  ComparedRecord compared;
  compared.name = file.filename().string();
  compared.record = record;
  const Comparison found = compare(experiment, std::move(compared), folder, show_progress());
  Results results = report(experiment, found);
  results.command = "identify";
  results.configuration["on_failure"] = to_string(experiment.on_failure);
  for (const ComparedRun& one : found.runs) {
    if (const std::string text = words(one.run.events); !text.empty()) results.paragraph(trouble + text);
    if (!one.diagnostics) continue;
    std::vector<std::string> outputs;
    for (const Eigen::Index i : output_channels(record)) outputs.push_back(record.channels[i].name);
    results.paragraph(words(*one.diagnostics, outputs));
    for (Figure& figure : figures(*one.diagnostics, outputs)) results.figures.push_back(std::move(figure));
  }
  return results;
}

void refuse_what_needs_an_oscillator(const Experiment& experiment) {
  const char* there = " is there for model sdof without [[parameters]] on a free decay";
  if (!experiment.smoother.empty()) throw UsageError(std::string("identify: a smoother") + there);
  if (experiment.estimator != "filter")
    throw UsageError("identify: estimator " + experiment.estimator + there);
  if (experiment.noise_method.name != "residual")
    throw InputError(experiment.noise_method.place, "noise.method " + experiment.noise_method.name + there);
}

/// Whether a step was added that the experiment file, silent about preparation, does not have.
bool keep_out_higher_modes(const fs::path& config, const fs::path& file, Experiment& experiment,
                           PreparedRecord& prepared) {
  if (!experiment.format.preparation.empty() || !is_free_oscillator(experiment, prepared.record))
    return false;
  try {
    const auto step = step_against_higher_modes(experiment, prepared.record);
    if (!step) return false;
    experiment.format.preparation = {*step};
    prepared = prepare_and_cut(std::move(prepared.raw), experiment.format, file);
    return true;
  } catch (const std::invalid_argument& error) {
    throw InputError({config.string()}, error.what());
  }
}

/// Of the whole record behind its preparation, where the experiment wants it.
Eigen::VectorXd quiet_noise(const Experiment& experiment, const PreparedRecord& prepared) {
  if (experiment.noise_method.name != "before_event") return {};
  try {
    return noise_before_event(prepare(prepared.raw, experiment.format.preparation));
  } catch (const std::invalid_argument& error) {
    throw InputError(experiment.noise_method.place, error.what());
  }
}

/// What the command line says in place of the experiment file.
void take_words(const options::variables_map& values, Experiment& experiment) {
  if (values.count("window")) {
    const auto& window = values["window"].as<std::vector<double>>();
    if (window.size() != 2) throw UsageError("identify: --window needs two times: FROM TO");
    experiment.format.window = {window[0], window[1]};
    experiment.format.window_place = {"--window"};
  }
  if (values.count("estimator")) {
    experiment.estimator = values["estimator"].as<std::string>();
    if (experiment.estimator != "filter" && experiment.estimator != "both")
      throw UsageError("identify: --estimator is '" + experiment.estimator + "'; expected filter or both");
  }
  try {
    if (values.count("on-failure"))
      experiment.on_failure = failure_response(values["on-failure"].as<std::string>());
    if (values.count("smoother")) experiment.smoother = values["smoother"].as<std::string>();
    if (!experiment.smoother.empty()) filters::smoother_registry().find(experiment.smoother);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("identify: ") + error.what());
  }
}

/// What --damping-law asks for; empty: nothing.
std::string damping_law(const options::variables_map& values) {
  if (!values.count("damping-law")) return {};
  const std::string law = values["damping-law"].as<std::string>();
  const auto& laws = damping_laws();
  if (law != "auto" && std::find(laws.begin(), laws.end(), law) == laws.end())
    throw UsageError("identify: unknown damping law '" + law + "'; known: auto, " + joined(laws));
  for (const char* other : {"smoother", "estimator"})
    if (values.count(other))
      throw UsageError(std::string("identify: --damping-law fits all samples at once; expected no --") +
                       other);
  return law;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()  //
      ("config", options::value<std::string>()->value_name("FILE"),
       "experiment file: beam, columns, units, window, filter (docs/configuration.md)")  //
      ("window", options::value<std::vector<double>>()->multitoken()->value_name("FROM TO"),
       "part of the record to use [s], instead of the experiment file's; after RECORD")  //
      ("on-failure", options::value<std::string>()->value_name("WHAT"),
       "when the filter fails: stop (default), inflate its covariance and go on, report and go on")  //
      ("smoother", options::value<std::string>()->value_name("NAME"),
       "rts or urts: what the whole record says of every instant, in smoothed.csv and a figure")  //
      ("estimator", options::value<std::string>()->value_name("WHICH"),
       "filter (default), or both: beside it the batch estimate, all samples at once")  //
      ("damping-law", options::value<std::string>()->value_name("LAW"),
       "auto, viscous, coulomb, quadratic or both: fit these laws to a free decay, with the evidence for "
       "each");
  described.add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {"record"}, values)) return 0;
  if (!values.count("config")) throw UsageError("identify: --config FILE is missing");

  const fs::path config = values["config"].as<std::string>();
  Experiment experiment = read_experiment(config);
  take_words(values, experiment);
  if (!values.count("record") && !experiment.record_file)
    throw UsageError("identify: no RECORD on the command line, and no 'file' under [record] in " +
                     config.string());
  const fs::path file = values.count("record") ? fs::path(values["record"].as<std::string>())
                                               : config.parent_path() / *experiment.record_file;
  PreparedRecord prepared = read_and_prepare(file, experiment.format);
  const Record& record = prepared.record;
  const bool thinned =
      damping_law(values).empty() && keep_out_higher_modes(config, file, experiment, prepared);
  if (!is_free_oscillator(experiment, record)) refuse_what_needs_an_oscillator(experiment);
  const std::string law = damping_law(values);
  deliver(values, [&] {
    try {
      Results results = !law.empty()
                            ? report(experiment, record, file.filename().string(),
                                     study_damping_law(experiment, record, law, config.parent_path()))
                        : is_free_oscillator(experiment, record)
                            ? report(experiment, record, file.filename().string(),
                                     identify_record(experiment, record, quiet_noise(experiment, prepared)))
                            : identify_generally(experiment, record, file, config.parent_path());
      if (thinned) results.paragraph(higher_modes);
      tell_preparation(results, prepared, experiment.format);
      return results;
    } catch (const std::invalid_argument& error) {
      throw InputError({config.string()}, error.what());
    }
  });
  return 0;
}

}  // namespace

Command identify_command() {
  return {"identify", "[RECORD] --config FILE [--window FROM TO] [--out DIR]",
          "stiffness, damping, frequency and damping ratio from a vibration record",
          "  beamid identify tip_acceleration.csv --config cantilever.toml --out results\n"
          "  beamid identify --config cantilever.toml --window 0.8 1.6\n"
          "  beamid identify --config cantilever.toml --estimator both\n"
          "  beamid identify --config cantilever.toml --on-failure inflate --smoother rts --out results\n"
          "  beamid identify --config cantilever.toml --damping-law auto --out results\n",
          run};
}

}  // namespace beamid::apps
