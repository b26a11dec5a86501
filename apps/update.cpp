// beamid update: parameters of a structure from measured frequencies and shapes.
#include "apps/command_parts.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/studies/update/report.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

int run_update(const Values& values) {
  const Experiment experiment = read_experiment(values.text("config"));
  require_linear_storeys(experiment, "update");
  const ModalData data = read_modal_data(values.text("modes"), experiment);
  return deliver(values, [&] {
    const UpdateStudy study = studied_update(values, experiment, data);
    Results results = report(experiment, study);
    warn(results, experiment);
    return results;
  });
}

}  // namespace

Command update_command() {
  return {
      "update",
      "MODES --config FILE [--model-error PERCENT] [--starts N] [--out DIR]",
      "parameters of a structure from measured frequencies and shapes",
      {{"modes", false, true,
        "a TOML file of [[modes]], the results.json of beamid modal, or a Universal File with datasets 55"}},
      {update_options(), output_options()},
      "  beamid update modes.toml --config building.toml\n"
      "  beamid update found/results.json --config building.toml --out updated\n"
      "  beamid update modes.toml --config beam.toml --model-error 0.2 --starts 1000\n",
      run_update,
      "",
      "3  no values of the parameters explain the modes: chi^2 is above its 99.9 % point.\n"};
}

}  // namespace beamid::apps
