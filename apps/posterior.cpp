// beamid posterior: the whole posterior of a structure's parameters.
#include <algorithm>
#include <optional>

#include "apps/command_parts.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/sensing/sensing_model.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/studies/posterior/report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

OptionGroup posterior_options() {
  return {"Draws",
          {whole("draws", "N", 100, 1000000, "of each of four chains; without it 1000, from a record 250"),
           whole("particles", "N", 100, 1000000,
                 "of each of two temperings that look for humps; without it 1000, from a record 200"),
           whole("seed", "N", 0, 4294967295.0, "of all random numbers").by_default("1")}};
}

// A likelihood of a record costs as much as a thousand of modes.
PosteriorSettings posterior_settings(const Values& values, bool of_record) {
  const auto count = [&](const char* name, std::size_t of_modes, std::size_t fewer) {
    return values.has(name) ? static_cast<std::size_t>(values.whole(name)) : of_record ? fewer : of_modes;
  };
  PosteriorSettings settings;
  settings.seed = static_cast<std::uint64_t>(values.number("seed"));
  settings.particles = count("particles", 1000, 200);
  settings.chains.draws = count("draws", 1000, 250);
  settings.importance_draws = std::max<std::size_t>(of_record ? 1000 : 8000, 2 * settings.chains.draws);
  return settings;
}

PosteriorStudy posterior_of_record(const Values& values, const Experiment& experiment, const Record& record) {
  const std::filesystem::path config = values.text("config");
  const Place place{config.string()};
  return study_posterior(experiment, sensing_record(experiment, record, place),
                         posterior_settings(values, true), config.parent_path(), place,
                         show_progress(values));
}

int run_posterior(const Values& values) {
  const Experiment experiment = read_experiment(values.text("config"));
  require_linear_storeys(experiment, "posterior");
  const std::filesystem::path file = values.text("modes");
  std::optional<ModalData> modes;
  if (holds_modes(file)) modes = read_modal_data(file, experiment);
  std::optional<PosteriorStudy> study;  // until its draws are written
  return deliver(values, [&] {
    PreparedRecord prepared;
    if (!modes) prepared = read_and_prepare(file, experiment.format);
    std::optional<UpdateStudy> update;
    if (modes) update = studied_update(values, experiment, *modes);
    try {
      study = modes ? study_posterior(std::move(*update), posterior_settings(values, false),
                                      show_progress(values))
                    : posterior_of_record(values, experiment, prepared.record);
    } catch (const std::invalid_argument& error) {
      throw InputError({values.text("config")}, error.what());
    }
    Results results = posterior_report(experiment, *study);
    if (!modes) add_preparation(results, prepared, experiment.format);
    warn(results, experiment);
    return results;
  });
}

}  // namespace

Command posterior_command() {
  return {
      "posterior",
      "MODES|RECORD --config FILE [--draws N] [--seed N] [--out DIR]",
      "the whole posterior of parameters from modes or a record: humps, evidence, draws",
      {{"modes", false, true,
        "a TOML file of [[modes]], the results.json of beamid modal, or a Universal File with datasets 55; "
        "any other file is a record, read "
        "as [record] states"}},
      {update_options(), posterior_options(), output_options()},
      "  beamid posterior modes.toml --config building.toml\n"
      "  beamid posterior modes.toml --config building.toml --draws 10000 --out drawn\n"
      "  beamid posterior hit.csv --config beam.toml --particles 300\n",
      run_posterior,
      "Priors are what [[parameters]] states: a standard deviation (normal; lognormal of form "
      "\"logarithmic\"), "
      "bounds (uniform).\nWhere none is stated, log-uniform within a factor of 10 of the initial estimate is "
      "assumed.\n",
      "3  the temperings, the humps or the chains disagree, no values explain the modes, or the record "
      "contradicts the structure: the first lines state by how much.\n"};
}

}  // namespace beamid::apps
