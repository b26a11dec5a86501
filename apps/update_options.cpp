#include "apps/update_options.hpp"

#include "apps/deliver.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::apps {

OptionGroup update_options() {
  return {
      "Options",
      {config_option("experiment file: the structure, [[parameters]], [[sensors]] of the shapes").needed(),
       number("model-error", "PERCENT",
              "what a predicted frequency is trusted to, one standard deviation [%]")
           .from(0)
           .up_to(20)
           .by_default("0.5"),
       number("shape-error", "PERCENT", "the same of a component of a shape, of the largest component [%]")
           .from(0)
           .up_to(100)
           .by_default("3"),
       whole("starts", "N", 1, 100000,
             "searches from so many places; without it 300, fewer of large structures")}};
}

experiments::UpdateSettings update_settings(const Values& values) {
  experiments::UpdateSettings settings;
  settings.trust = {values.number("model-error") / 100.0, values.number("shape-error") / 100.0};
  if (values.has("starts")) settings.starts = values.whole("starts");
  return settings;
}

experiments::UpdateStudy studied_update(const Values& values, const experiments::Experiment& experiment,
                                        const experiments::ModalData& data) {
  for (const experiments::MeasuredMode& mode : data.modes) {
    if (!(mode.deviation_hz > 0.0) && !(values.number("model-error") > 0.0))
      throw UsageError(
          "--model-error is 0, and a mode has no standard deviation of its own; expected one of "
          "the two above zero");
    if (mode.shape.size() > 1 && !(mode.shape_deviation > 0.0) && !(values.number("shape-error") > 0.0))
      throw UsageError(
          "--shape-error is 0, and a shape has no standard deviation of its own; expected one of "
          "the two above zero");
  }
  try {
    return experiments::study_update(experiment, data, update_settings(values), show_progress(values));
  } catch (const std::invalid_argument& error) {
    throw experiments::InputError({values.text("config")}, error.what());
  }
}

}  // namespace beamid::apps
