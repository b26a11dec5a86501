// beamid simulate: the virtual test rig.
#include "apps/beam_options.hpp"
#include "apps/deliver.hpp"
#include "experiments/config/read_acquisition.hpp"
#include "experiments/studies/continuum/simulation_report.hpp"

namespace beamid::apps {
namespace {

const std::vector<KeyOption>& simulation_keys() {
  static const std::vector<KeyOption> keys{
      {"duration", "simulation", "duration_s", {}, "S", "of the record [s]"},
      {"sampling-rate", "simulation", "sampling_rate_hz", {}, "HZ", "of the record [Hz]"},
      {"method", "simulation", "method", {}, "NAME", "of integration: beamid list responses", true}};
  return keys;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  describe(simulation_keys(), described);
  described.add_options()("surface", "draw the real sections in the meshes for ParaView");
  described.add(beam_options()).add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {}, values)) return 0;
  const BeamSource source = read_beam(command, values, simulation_keys());
  experiments::Acquisition acquisition;
  if (!source.config.empty())
    acquisition = experiments::read_acquisition(experiments::TomlTable::read(source.config));
  const int frames = values.count("out") ? source.experiment.simulation.frames : 0;  // nobody would see them
  deliver(values, [&] {
    return blame_config(source, [&] {
      const auto test = std::make_shared<const experiments::SimulatedTest>(experiments::simulate(
          source.experiment, source.config.parent_path(), frames, show_progress(), acquisition));
      return experiments::report(source.experiment, test, values.count("surface") > 0);
    });
  });
  return 0;
}

}  // namespace

Command simulate_command() {
  return {"simulate", "[--config FILE] [BEAM OPTIONS] [--out DIR]",
          "the motion of a beam under a release, force, impulse or moving base, as sensors record it",
          "  beamid simulate --damping-ratio 0.002 --duration 25 --out results\n"
          "  beamid simulate --config rig.toml --out results\n"
          "  beamid simulate --config rig.toml --method newmark --sampling-rate 5000\n",
          run};
}

}  // namespace beamid::apps
