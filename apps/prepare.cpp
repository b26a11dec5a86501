// beamid prepare: a record filtered, integrated, cut; and what that does to its frequency and damping.
#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

int run_prepare(const Values& values) {
  const std::filesystem::path config = values.text("config");
  Experiment experiment = read_experiment(config);
  const std::filesystem::path file =
      require_record_files(values, config, experiment.record_file, experiment.format)[0];
  if (experiment.format.preparation.empty())
    throw InputError({config.string()}, "no step; expected at least one table [[record.prepare]]");
  return deliver(values, [&] {
    return report(read_and_prepare(file, experiment.format), experiment.format, experiment.title,
                  file.filename().string());
  });
}

}  // namespace

Command prepare_command() {
  return {"prepare",
          "[RECORD] --config FILE [--out DIR]",
          "a record filtered, integrated, decimated, cut; what each step costs in frequency and damping",
          {record_argument()},
          {{"Options",
            {config_option("experiment file with the steps, [[record.prepare]] (docs/configuration.md)")
                 .needed()}},
           column_options(),
           output_options()},
          "  beamid prepare tip_acceleration.csv --config cantilever.toml --out results\n"
          "  beamid list steps\n",
          run_prepare};
}

}  // namespace beamid::apps
