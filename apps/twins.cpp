// beamid twins: every set of parameters that explains the modes as well.
#include "apps/command_parts.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/studies/twins/record_report.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

int run_twins(const Values& values) {
  const Experiment experiment = read_experiment(values.text("config"));
  require_linear_storeys(experiment, "twins");
  return deliver(values, [&] {
    const ModalData data =
        values.has("modes") ? read_modal_data(values.text("modes"), experiment) : described_modes(experiment);
    const UpdateStudy study = studied_update(values, experiment, data);
    Results results = twins_report(experiment, study);
    warn(results, experiment);
    return results;
  });
}

}  // namespace

Command twins_command() {
  return {"twins",
          "[MODES] --config FILE [--model-error PERCENT] [--starts N] [--out DIR]",
          "all sets of parameters that explain the modes equally well, and the measurement that decides",
          {{"modes", false, false}},
          {update_options(), output_options()},
          "  beamid twins --config building.toml\n"
          "  beamid twins modes.toml --config building.toml --out twins\n",
          run_twins,
          "Without MODES the frequencies of the structure as described are taken, as many as there are "
          "parameters.\n",
          "3  no values of the parameters explain the modes: chi^2 is above its 99.9 % point.\n"};
}

}  // namespace beamid::apps
