// beamid modes: natural frequencies and mode shapes, each with what tells how far to trust it.
#include "apps/beam_options.hpp"
#include "apps/command.hpp"
#include "apps/deliver.hpp"
#include "experiments/studies/continuum/frame_modes.hpp"
#include "experiments/studies/continuum/modal_report.hpp"

namespace beamid::apps {
namespace {

int run_modes(const Values& values) {
  const BeamSource source = read_beam(values);
  return deliver(values, [&] {
    if (const fem::Frame* const frame = source.experiment.structure.frame()) {
      const experiments::FrameExperiment described =
          experiments::as_frame_experiment(*frame, source.experiment.elements, source.experiment.title);
      return blame_config(source, [&] {
        return experiments::report(
            described, experiments::frame_modes(described, values.whole("modes"), show_progress(values)));
      });
    }
    if (source.experiment.structure.space_frame())
      return blame_config(source, [&] {
        const experiments::Experiment& experiment = source.experiment;
        return experiments::report(experiment,
                                   experiments::frame_modes(experiment.structure, experiment.elements,
                                                            values.whole("modes"), show_progress(values)),
                                   values.has("surface"));
      });
    return blame_config(source, [&] {
      const auto summary =
          experiments::summarise_modes(source.experiment, values.whole("modes"), show_progress(values));
      return experiments::report(source.experiment, summary, values.has("surface"));
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
