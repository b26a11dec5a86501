// beamid posterior: the whole posterior of a structure's parameters.
#include <algorithm>
#include <optional>

#include "apps/deliver.hpp"
#include "apps/update_options.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/read_modal_data.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/studies/posterior/report.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

OptionGroup posterior_options() {
  return {"Draws",
          {whole("draws", "N", 100, 1000000, "of each of four chains").by_default("1000"),
           whole("particles", "N", 100, 1000000, "of the tempering that looks for humps").by_default("1000"),
           whole("seed", "N", 0, 4294967295.0, "of all random numbers").by_default("1")}};
}

PosteriorSettings posterior_settings(const Values& values) {
  PosteriorSettings settings;
  settings.seed = static_cast<std::uint64_t>(values.number("seed"));
  settings.particles = static_cast<std::size_t>(values.whole("particles"));
  settings.chains.draws = static_cast<std::size_t>(values.whole("draws"));
  settings.importance_draws = std::max<std::size_t>(8000, 2 * settings.chains.draws);
  return settings;
}

int run_posterior(const Values& values) {
  const Experiment experiment = read_experiment(values.text("config"));
  const ModalData data = read_modal_data(values.text("modes"), experiment);
  std::optional<PosteriorStudy> study;  // until its draws are written
  deliver(values, [&] {
    UpdateStudy update = studied_update(values, experiment, data);
    try {
      study = study_posterior(std::move(update), posterior_settings(values), show_progress(values));
    } catch (const std::invalid_argument& error) {
      throw InputError({values.text("config")}, error.what());
    }
    Results results = posterior_report(experiment, *study);
    warn(results, experiment);
    return results;
  });
  return 0;
}

}  // namespace

Command posterior_command() {
  return {"posterior",
          "MODES --config FILE [--draws N] [--seed N] [--out DIR]",
          "the whole posterior of parameters from measured modes: humps, evidence, draws",
          {{"modes", false, true, "a TOML file of [[modes]], or the results.json of beamid modal"}},
          {update_options(), posterior_options(), output_options()},
          "  beamid posterior modes.toml --config building.toml\n"
          "  beamid posterior modes.toml --config building.toml --draws 10000 --out drawn\n",
          run_posterior,
          "Priors are what [[parameters]] states: a deviation (normal; lognormal of form \"logarithmic\"), "
          "bounds "
          "(uniform). Where\nnothing is stated, log-uniform within a factor of 10 of the initial estimate is "
          "assumed.\n"};
}

}  // namespace beamid::apps
