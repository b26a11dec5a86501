// beamid backbone: the force law of an oscillator out of windows of changing amplitude.
#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/modal/study/driven_study.hpp"
#include "experiments/modal/study/record_kind.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/studies/backbone/report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

OptionGroup backbone_options() {
  return {
      "Options",
      {band_option("frequencies between which the mode is at its largest [Hz]; else the strongest line"),
       number("mass", "KG", "of the oscillator at the sensor; else forces are those of 1 kg").greater_than(0),
       number("amplitude-ratio", "R", "a window ends where the amplitude has fallen to this part")
           .greater_than(0.1)
           .less_than(1)
           .by_default("0.8"),
       number("fewest-cycles", "N", "but is no shorter than this").from(2).less_than(1e4).by_default("3"),
       number("linear", "PERCENT", "change of the stiffness below which the spring counts as linear")
           .greater_than(0)
           .less_than(100)
           .by_default("1")}};
}

BackboneSettings backbone_settings_of(const Values& values) {
  BackboneSettings settings;
  settings.windows.band_hz = values.from_to("band");
  settings.windows.amplitude_ratio = values.number("amplitude-ratio");
  settings.windows.fewest_cycles = values.number("fewest-cycles");
  settings.linear = 0.01 * values.number("linear");
  settings.mass_known = values.has("mass");
  if (settings.mass_known) settings.windows.mass = values.number("mass");
  return settings;
}

int run_backbone(const Values& values) {
  const BackboneSettings settings = backbone_settings_of(values);
  const RecordRequest request = record_requests(values).front();
  return deliver(values, [&] {
    PreparedRecord prepared = read_and_prepare(request.file, request.format);
    prepared.record = made_analysable(prepared.record);
    if (request.format.channels.empty()) put_strongest_first(prepared.record);
    const Record measured = std::move(prepared.record);
    const std::string file = request.file.string();
    const std::vector<Eigen::Index> outputs = output_channels(measured);
    if (outputs.empty()) throw InputError({file}, "holds forces only; expected a channel of motion");
    if (measured.channels[static_cast<std::size_t>(outputs[0])].quantity == Quantity::strain)
      throw InputError({file},
                       "its first channel is strain; expected displacement, velocity or acceleration");
    refuse_driven(file, measured, request.format.window.has_value());
    try {
      prepared.record = complete_part(motion_of(measured), prepared.record.remarks);
      if (!request.format.window)
        prepared.record = from_release(prepared.record, measured, prepared.record.remarks);
      const Record& record = prepared.record;
      Results results =
          report(settings, record, request.file.filename().string(), study_backbone(record, settings));
      add_preparation(results, prepared, request.format);
      return results;
    } catch (const std::invalid_argument& error) {
      throw InputError({file}, error.what());
    }
  });
}

}  // namespace

Command backbone_command() {
  return {"backbone",
          "RECORD [--config FILE] [--mass KG] [--amplitude-ratio R] [--out DIR]",
          "the force law of one mode from a decay: stiffness and damping by amplitude, backbone, loop",
          {record_argument()},
          {backbone_options(), record_options(), output_options()},
          "  beamid backbone release.csv --mass 1.08 --out results\n"
          "  beamid backbone tip_acceleration.csv --window 1 20 --band 4 10\n"
          "  beamid backbone --config cantilever.toml --amplitude-ratio 0.7 --fewest-cycles 5\n",
          run_backbone};
}

}  // namespace beamid::apps
