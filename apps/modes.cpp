// beamid modes: natural frequencies and mode shapes, each with what tells how far to trust it.
#include "apps/beam_options.hpp"
#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "experiments/studies/continuum/report.hpp"

namespace beamid::apps {
namespace {

int run_modes(const Values& values) {
  const BeamSource source = read_beam(values);
  return deliver(values, [&] {
    return blame_config(source, [&] {
      return experiments::modes_study(source.experiment, values.whole("modes"), values.has("surface"),
                                      show_progress(values));
    });
  });
}

}  // namespace

Command modes_command() {
  return {
      "modes",
      "[--config FILE] [BEAM OPTIONS] [--modes K] [--out DIR]",
      "natural frequencies and mode shapes of a structure, with their errors",
      {},
      {{"Options", {whole("modes", "K", 1, 1000, "how many, the lowest").by_default("10"), surface_option()}},
       beam_options(),
       output_options()},
      "  beamid modes\n"
      "  beamid modes --tip-mass 0.36 --axial-load 100 --modes 5\n"
      "  beamid modes --support clamped-clamped --diameter 0.02 --elements 200\n"
      "  beamid modes --config wing.toml --surface --out results\n",
      run_modes};
}

}  // namespace beamid::apps
