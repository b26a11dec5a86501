// beamid sense: motion, strain and force where no sensor was.
#include <algorithm>
#include <filesystem>

#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/studies/sensing/report.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/fields.hpp"
#include "filters/filter.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

// Of a beam whatever can be asked of a section; of other structures the displacement of the place.
void add_place(const std::string& text, Experiment& experiment) {
  const fem::Structure& structure = experiment.structure;
  if (!structure.has_positions()) {
    const std::vector<std::string> known = fem::place_names(structure);
    if (std::find(known.begin(), known.end(), text) == known.end())
      throw UsageError("--at " + text + ": no such place of the structure");
    experiment.virtual_sensors.push_back(
        {"displacement_" + text, Quantity::displacement, false, {}, 0.0, text});
    return;
  }
  const ParsedNumber parsed = parse_number(text);
  const double position = parsed.value;
  if (!parsed.finite || !(position >= 0.0 && position <= structure.extent()))
    throw UsageError("--at " + text + ": expected a position on the structure [m]");
  const std::string place = name_of_place(position, structure.extent());
  experiment.virtual_sensors.push_back({"displacement_" + place, Quantity::displacement, false, position});
  if (!structure.is_chain())
    experiment.virtual_sensors.push_back(bending_moment_at(structure.beam(), position));
}

int run_sense(const Values& values) {
  const fs::path config = values.text("config");
  if (config.empty()) throw UsageError("--config FILE is missing");
  Experiment experiment = read_experiment(config);
  require_linear_storeys(experiment, "sense");
  for (const std::string& place : values.texts("at")) add_place(place, experiment);
  if (experiment.unknown_forces.empty())
    throw InputError({config.string()},
                     "no [[unknown_forces]]; expected where the forces act that were not measured");
  std::optional<Choice> filter;
  if (!values.text("filter").empty())
    filter = parse_choice(values.text("filter"), "--filter", filters::filter_registry());
  const std::vector<fs::path> file = record_files(values, config, experiment.record_file, experiment.format);
  return deliver(values, [&] {
    const Progress progress = show_progress(values);
    const Place place{config.string()};
    PreparedRecord prepared;
    if (!file.empty()) prepared = read_and_prepare(file[0], experiment.format);
    Results results = at_place(place, [&] {
      if (!file.empty()) return sensed_record(experiment, prepared, file[0], config, progress, filter);
      const fs::path folder = config.parent_path();
      const SensingRecord record = simulated_sensing(experiment, folder, place, progress);
      const Choice reduction = sensing_reduction(experiment, record.record.interval());
      return sensing_report(
          experiment, study_sensing(experiment, record, reduction, folder, progress, filter), "Simulated");
    });
    return results;
  });
}

}  // namespace

Command sense_command() {
  return {"sense",
          "[RECORD] --config FILE [--at POSITION...] [--filter NAME] [--out DIR]",
          "displacement, strain, moment and force where no sensor was, under unmeasured forces",
          {record_argument()},
          {{"Options",
            {config_option("experiment file with [[unknown_forces]] (docs/configuration.md)"),
             text("at", "POSITION",
                  "a place of interest [m], or its name: displacement, and of a beam "
                  "bending moment; more by [[virtual_sensors]]")
                 .several(),
             filter_option("histories sample after sample by this filter, in place of the smoother: "
                           "gillijns_de_moor and dual_kf assume no knowledge of the forces")}},
           column_options(),
           output_options()},
          "  beamid sense record.csv --config mast.toml --at 0 --out sensed\n"
          "  beamid sense --config mast.toml\n"
          "  beamid sense --config mast.toml --filter gillijns_de_moor\n",
          run_sense,
          "",
          "3  no estimate to rely on, and \"status\" in results.json states why: constants \"not "
          "converged\", the "
          "structure \"contradicted\", or innovations \"correlated\"\n"};
}

}  // namespace beamid::apps
