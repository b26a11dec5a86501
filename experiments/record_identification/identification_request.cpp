#include "experiments/record_identification/identification_request.hpp"

#include <algorithm>

#include "experiments/model_setting.hpp"
#include "experiments/record_identification/decay_window.hpp"
#include "experiments/record_identification/higher_modes.hpp"

namespace beamid::experiments {

bool IdentificationRequest::is_free_oscillator() const {
  return experiment.model.name == "sdof" && experiment.parameters.empty() &&
         force_channels(prepared.record).empty();
}

void cut_decay(IdentificationRequest& one) {
  RecordFormat& format = one.experiment.format;
  if (format.window || !one.is_free_oscillator()) return;
  const auto window = decay_window(one.experiment, one.prepared.record);
  if (!window) return;
  format.window = {window->from, window->to};
  one.window = window->words();
  one.prepared.take(one.prepared.record, format, one.file);
}

void keep_out_higher_modes(IdentificationRequest& one) {
  RecordFormat& format = one.experiment.format;
  if (!format.preparation.empty() || !one.is_free_oscillator()) return;
  const auto step = step_against_higher_modes(one.experiment, one.prepared.record);
  if (!step) return;
  format.preparation = {*step};
  Record left = prepare(one.prepared.raw, format.preparation, format.window);
  if (auto& window = format.window)  // the low-pass takes a little of both ends
    window = {std::max(window->first, left.time[0]), std::min(window->second, left.time[left.size() - 1])};
  one.prepared.take(std::move(left), format, one.file);
  one.thinned = true;
}

}  // namespace beamid::experiments
