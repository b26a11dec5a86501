// beamid identify: a real record in, stiffness and damping with intervals out.
#include <filesystem>

#include "apps/deliver.hpp"
#include "experiments/input/read_experiment.hpp"
#include "experiments/input/read_record.hpp"
#include "experiments/model_setting.hpp"
#include "experiments/record_comparison/comparison.hpp"
#include "experiments/record_identification/record_identification.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

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
  Results results = report(experiment, compare(experiment, std::move(compared), folder, show_progress()));
  results.command = "identify";
  return results;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()  //
      ("config", options::value<std::string>()->value_name("FILE"),
       "experiment file: beam, columns, units, window, filter (docs/configuration.md)")  //
      ("window", options::value<std::vector<double>>()->multitoken()->value_name("FROM TO"),
       "part of the record to use [s], instead of the experiment file's; after RECORD");
  described.add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {"record"}, values)) return 0;
  if (!values.count("config")) throw UsageError("identify: --config FILE is missing");

  const fs::path config = values["config"].as<std::string>();
  Experiment experiment = read_experiment(config);
  if (values.count("window")) {
    const auto& window = values["window"].as<std::vector<double>>();
    if (window.size() != 2) throw UsageError("identify: --window needs two times: FROM TO");
    experiment.format.window = {window[0], window[1]};
    experiment.format.window_place = {"--window"};
  }
  if (!values.count("record") && !experiment.record_file)
    throw UsageError("identify: no RECORD on the command line, and no 'file' under [record] in " +
                     config.string());
  const fs::path file = values.count("record") ? fs::path(values["record"].as<std::string>())
                                               : config.parent_path() / *experiment.record_file;
  const Record record = read_record(file, experiment.format);
  deliver(values, [&] {
    try {
      if (!is_free_oscillator(experiment, record))
        return identify_generally(experiment, record, file, config.parent_path());
      return report(experiment, record, file.filename().string(), identify_record(experiment, record));
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
          "  beamid identify --config cantilever.toml --window 0.8 1.6\n",
          run};
}

}  // namespace beamid::apps
