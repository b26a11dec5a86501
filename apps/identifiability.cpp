// beamid identifiability: what a test can tell about a beam, before it is made.
#include "apps/beam_options.hpp"
#include "apps/deliver.hpp"
#include "apps/model_option.hpp"
#include "experiments/config/read_reduction.hpp"
#include "experiments/studies/bounds/report.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

const std::vector<KeyOption>& test_keys() {
  static const std::vector<KeyOption> keys{
      {"duration", "simulation", "duration_s", {}, "S", "of the record [s]"},
      {"sampling-rate", "simulation", "sampling_rate_hz", {}, "HZ", "of the record [Hz]"}};
  return keys;
}

/// What the command line says replaces what the file says; where neither does, the beam itself is asked about
/// on its first three modes.
void complete(const options::variables_map& values, Experiment& experiment) {
  choose_model(values, experiment);
  if (values.count("reduction"))
    experiment.reduction = parse_reduction(values["reduction"].as<std::string>(), "--reduction");
  else if (experiment.reduction.place.line == 0)
    experiment.reduction = parse_reduction(
        experiment.model.name == "sdof" ? "rayleigh" : "modal_truncation:modes=3", "default reduction");
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()  //
      ("model", options::value<std::string>()->value_name("NAME"),
       "what is asked: beamid list models [beam]")  //
      ("reduction", options::value<std::string>()->value_name("NAME[:OPTION=VALUE,...]"),
       "of the beam: beamid list reductions [modal_truncation:modes=3; rayleigh for model sdof]");
  describe(test_keys(), described);
  described.add(beam_options()).add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {}, values)) return 0;
  BeamSource source = read_beam(command, values, test_keys());
  complete(values, source.experiment);
  deliver(values, [&] {
    return blame_config(source, [&] {
      return report(source.experiment,
                    find_identifiability(source.experiment, source.config.parent_path(), show_progress()));
    });
  });
  return 0;
}

}  // namespace

Command identifiability_command() {
  return {"identifiability", "[--config FILE] [BEAM OPTIONS] [--model NAME] [--reduction NAME] [--out DIR]",
          "what a test can tell at best of which parameter, and what would change that",
          "  beamid identifiability\n"
          "  beamid identifiability --tip-mass 3.644615 --damping-ratio 0.0015 --duration 25\n"
          "  beamid identifiability --model sdof --out results\n"
          "  beamid identifiability --config rig.toml --reduction modal_truncation:modes=5 --out results\n",
          run};
}

}  // namespace beamid::apps
