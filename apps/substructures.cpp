// beamid substructures: a structure identified part by part.
#include <filesystem>

#include "apps/beam_options.hpp"
#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/studies/substructures/report.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

int run_substructures(const Values& values) {
  const fs::path config = values.text("config");
  if (config.empty()) throw UsageError("--config FILE is missing");
  Experiment experiment = read_experiment(config);
  require_linear_storeys(experiment, "substructures");
  if (experiment.parts.empty())
    throw InputError({config.string()}, "no [[substructures]]; expected the parts to be identified");
  if (experiment.parameters.empty())
    throw InputError({config.string()}, "no [[parameters]]; expected what is to be determined of the parts");
  const std::vector<fs::path> file = record_files(values, config, experiment.record_file, experiment.format);
  return deliver(values, [&] {
    const Progress progress = show_progress(values);
    ComparedRecord record;
    PreparedRecord prepared;
    if (file.empty()) {
      record = simulated_for_parts(experiment, config.parent_path(), progress);
    } else {
      prepared = read_and_prepare(file[0], experiment.format);
      record = measured_record(file[0].filename().string(), prepared.record);
    }
    Results results = [&] {
      try {
        const PartedIdentification found =
            identify_parts(experiment, record, config.parent_path(), !values.has("no-whole"), progress);
        return substructures_report(experiment, found);
      } catch (const std::invalid_argument& error) {
        throw InputError({config.string()}, error.what());
      }
    }();
    if (!file.empty()) add_preparation(results, prepared, experiment.format);
    return results;
  });
}

}  // namespace

Command substructures_command() {
  return {"substructures",
          "[RECORD] --config FILE [--no-whole] [--out DIR]",
          "a structure identified part by part, the motion between the parts measured",
          {record_argument()},
          {{"Options",
            {config_option("experiment file with [[substructures]] (docs/configuration.md)"),
             flag("no-whole", "omit the identification of the whole structure beside its parts")}},
           column_options(),
           output_options()},
          "  beamid substructures --config building.toml --out parts\n"
          "  beamid substructures record.csv --config building.toml --no-whole\n",
          run_substructures,
          "",
          "3  a part has no estimate to rely on: its filter \"diverged\", or the record \"contradicted\" it; "
          "what "
          "is joined is of the others.\n"};
}

}  // namespace beamid::apps
