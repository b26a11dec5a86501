// beamid simulate: the virtual test rig.
#include "apps/beam_options.hpp"
#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "experiments/studies/continuum/report.hpp"
#include "fem/response/response.hpp"

namespace beamid::apps {
namespace {

std::vector<KeyOption> simulation_keys() {
  Words methods;
  for (const auto& method : fem::response_methods()) methods.push_back(method.name);
  std::vector<KeyOption> keys = record_length_keys();
  keys.push_back({text("method", "NAME", "of integration: beamid list responses").such_as(methods),
                  "simulation", "method"});
  return keys;
}

int run_simulate(const Values& values) {
  const BeamSource source = read_beam(values, simulation_keys());
  const int frames = values.has("out") ? source.experiment.simulation.frames : 0;  // nobody would see them
  return deliver(values, [&] {
    return blame_config(source, [&] {
      const auto motion = std::make_shared<experiments::WholeMotion>();
      const auto test = std::make_shared<const experiments::SimulatedTest>(
          experiments::simulate(source.experiment, source.config.parent_path(), frames, show_progress(values),
                                source.experiment.acquisition, frames > 0 ? motion.get() : nullptr));
      return experiments::report(source.experiment, test, values.has("surface"), motion);
    });
  });
}

}  // namespace

Command simulate_command() {
  return {"simulate",
          "[--config FILE] [BEAM OPTIONS] [--out DIR]",
          "the motion of a beam under a release, force, impulse or moving base, as sensors record it",
          {},
          {key_options(simulation_keys(), {surface_option()}), beam_options(), output_options()},
          "  beamid simulate --damping-ratio 0.002 --duration 25 --out results\n"
          "  beamid simulate --config rig.toml --out results\n"
          "  beamid simulate --config rig.toml --method newmark --sampling-rate 5000\n",
          run_simulate};
}

}  // namespace beamid::apps
