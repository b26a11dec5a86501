#include "experiments/studies/continuum/modes_study.hpp"

#include "experiments/studies/continuum/frame_modes.hpp"
#include "experiments/studies/continuum/modal_report.hpp"

namespace beamid::experiments {

Results modes_study(const Experiment& experiment, Eigen::Index count, bool surface,
                    const Progress& progress) {
  const fem::Structure& structure = experiment.structure;
  if (structure.frame() || structure.space_frame())
    return report(experiment, frame_modes(structure, experiment.elements, count, progress), surface);
  return report(experiment, summarise_modes(experiment, count, progress), surface);
}

}  // namespace beamid::experiments
