#include "experiments/record_identification/higher_modes.hpp"

#include "experiments/preparation/preparation_step.hpp"
#include "experiments/record_identification/record_identification.hpp"

namespace beamid::experiments {

std::optional<Choice> step_against_higher_modes(const Experiment& experiment, const Record& record) {
  constexpr double coloured = 3.0, samples_per_cycle = 8.0;
  const ModalEstimate modal = prepare_identification(experiment, record).modal;
  if (!(modal.residual_standard_deviation > coloured * modal.noise_standard_deviation)) return {};
  const int factor = static_cast<int>(1.0 / (samples_per_cycle * modal.frequency_hz * record.interval()));
  constexpr int least = 2, most = 1000;  // of the step
  if (factor < least || factor > most) return {};
  filters::Options options;
  options.set("factor", static_cast<double>(factor));
  return Choice{"decimate", step_registry().completed("decimate", options)};
}

}  // namespace beamid::experiments
