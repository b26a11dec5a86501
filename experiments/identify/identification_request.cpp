#include "experiments/identify/identification_request.hpp"

#include <algorithm>

#include "experiments/identify/analysis.hpp"
#include "experiments/identify/decay_window.hpp"
#include "experiments/identify/higher_modes.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/noise_source.hpp"
#include "experiments/identify/sound_part.hpp"
#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::experiments {

bool IdentificationRequest::is_free_oscillator() const {
  return asks_free_oscillator(experiment, prepared.record);
}

PreparedRecord IdentificationRequest::as_analysed() const {
  PreparedRecord result = prepared;
  if (const std::string remark = analysable(prepared.record).remark; !remark.empty())
    result.record.remarks.push_back("For the modal analysis and first estimates: " + remark);
  return result;
}

ComparedRecord IdentificationRequest::compared() const {
  ComparedRecord record = measured_record(file.filename().string(), prepared.record);
  if (experiment.noise_method.name == "before_event")  // of the whole record behind its preparation
    record.quiet_noise = at_place(experiment.noise_method.place, [&] {
      return noise_before_event(prepare(prepared.raw, experiment.format.preparation));
    });
  return record;
}

std::vector<std::string> IdentificationRequest::decisions() const {
  std::vector<std::string> said;
  if (!window.empty()) said.push_back(window);
  if (thinned)
    said.push_back(
        "Higher modes are a large part of this record. A filter of one mode would take them for white noise: "
        "the record was low-passed and decimated first, which changes neither frequency nor damping. Any "
        "[[record.prepare]] of the experiment file takes the place of this.");
  return said;
}

namespace {

// Whether higher modes are noise to the model, as they are to one degree of freedom.
bool is_beam_of_one_mode(const IdentificationRequest& one, const Choice& reduction) {
  const auto& options = reduction.options.values();
  const auto modes = options.find("modes");
  const bool single = reduction.name == "rayleigh" ||
                      (reduction.name == "modal_truncation" &&
                       (modes == options.end() || modes->second == filters::OptionValue(1.0)));
  return one.experiment.model.name == "beam" && single && input_channels(one.prepared.record).empty();
}

}  // namespace

void cut_decay(IdentificationRequest& one) {
  RecordFormat& format = one.experiment.format;
  const bool driven = !input_channels(one.prepared.record).empty() || !one.experiment.unknown_forces.empty();
  if (format.window || driven) return;
  Record& record = one.prepared.record;
  if (const auto window = decay_window(one.experiment, record)) {
    format.window = {window->from, window->to};
    one.window = window->words();
  }
  const Record decay = format.window ? record.window(format.window->first, format.window->second) : record;
  if (const auto part = sound_part(one.experiment, decay, one.prepared.defects)) {
    format.window = {part->from, part->to};
    one.window += one.window.empty() ? "No window was given. " + part->words +
                                           " record.window_s or --window takes the place of this."
                                     : " " + part->words;
  }
  if (format.window) one.prepared.take(record, format, one.file);
}

void keep_out_higher_modes(IdentificationRequest& one, const std::vector<Choice>& reductions) {
  RecordFormat& format = one.experiment.format;
  if (!format.preparation.empty() || !one.experiment.unknown_forces.empty()) return;
  const std::vector<Choice> asked = reductions.empty() ? std::vector{one.experiment.reduction} : reductions;
  if (!one.is_free_oscillator() &&
      !std::all_of(asked.begin(), asked.end(), [&](const Choice& c) { return is_beam_of_one_mode(one, c); }))
    return;
  Experiment oscillator = one.experiment;  // the same question, whatever model asks it
  oscillator.model = {"sdof", model_registry().completed("sdof", {})};
  oscillator.parameters.clear();
  const auto step = step_against_higher_modes(oscillator, one.prepared.record);
  if (!step) return;
  format.preparation = {*step};
  Record left = prepare(one.prepared.raw, format.preparation, format.window);
  if (auto& window = format.window)  // the low-pass takes a little of both ends
    window = {std::max(window->first, left.time[0]), std::min(window->second, left.time[left.size() - 1])};
  one.prepared.take(std::move(left), format, one.file);
  one.thinned = true;
}

}  // namespace beamid::experiments
