// beamid identifiability: what a test can tell about a beam, before it is made.
#include "apps/beam_options.hpp"
#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/studies/bounds/report.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

/// What the command line says replaces what the file says; where neither does, the beam itself is asked about
/// on its first three modes.
void complete_identifiability(const Values& values, Experiment& experiment) {
  choose_model(values, experiment);
  if (values.has("reduction"))
    experiment.reduction = parse_reduction(values.text("reduction"), "--reduction");
  else if (experiment.reduction.place.line == 0 && experiment.storey_springs.empty())
    experiment.reduction = parse_reduction(
        experiment.model.name == "sdof" ? "rayleigh" : "modal_truncation:modes=3", "default reduction");
}

int run_identifiability(const Values& values) {
  BeamSource source = read_beam(values, record_length_keys());
  complete_identifiability(values, source.experiment);
  return deliver(values, [&] {
    return blame_config(source, [&] {
      return report(source.experiment, find_identifiability(source.experiment, source.config.parent_path(),
                                                            show_progress(values)));
    });
  });
}

}  // namespace

Command identifiability_command() {
  OptionGroup own = key_options(record_length_keys());
  own.options.insert(
      own.options.begin(),
      {model_option(), reduction_option("of the beam: beamid list reductions; rayleigh for model sdof")
                           .by_default("modal_truncation:modes=3")});
  return {"identifiability",
          "[--config FILE] [BEAM OPTIONS] [--model NAME] [--reduction NAME] [--out DIR]",
          "the accuracy that a planned test allows for each parameter, and what would improve it",
          {},
          {own, beam_options(), output_options()},
          "  beamid identifiability\n"
          "  beamid identifiability --tip-mass 3.644615 --damping-ratio 0.0015 --duration 25\n"
          "  beamid identifiability --model sdof --out results\n"
          "  beamid identifiability --config rig.toml --reduction modal_truncation:modes=5 --out results\n",
          run_identifiability};
}

}  // namespace beamid::apps
