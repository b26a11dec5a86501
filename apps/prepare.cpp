// beamid prepare: a record filtered, integrated, cut; and what that does to its frequency and damping.
#include <filesystem>

#include "apps/deliver.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()("config", options::value<std::string>()->value_name("FILE"),
                          "experiment file with the steps, [[record.prepare]] (docs/configuration.md)");
  described.add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {"record"}, values)) return 0;
  if (!values.count("config")) throw UsageError("prepare: --config FILE is missing");
  const fs::path config = values["config"].as<std::string>();
  const Experiment experiment = read_experiment(config);
  if (!values.count("record") && !experiment.record_file)
    throw UsageError("prepare: no RECORD on the command line, and no 'file' under [record] in " +
                     config.string());
  if (experiment.format.preparation.empty())
    throw InputError({config.string()}, "no step; expected at least one table [[record.prepare]]");
  const fs::path file = values.count("record") ? fs::path(values["record"].as<std::string>())
                                               : config.parent_path() / *experiment.record_file;
  deliver(values, [&] {
    return report(read_and_prepare(file, experiment.format), experiment.format, experiment.title,
                  file.filename().string());
  });
  return 0;
}

}  // namespace

Command prepare_command() {
  return {"prepare", "[RECORD] --config FILE [--out DIR]",
          "a record filtered, integrated, decimated, cut; what each step costs in frequency and damping",
          "  beamid prepare tip_acceleration.csv --config cantilever.toml --out results\n"
          "  beamid list steps\n",
          run};
}

}  // namespace beamid::apps
