// beamid steps: the decisive experiment on a user's own record, and what lay behind a published damping
// ratio.
#include <fmt/format.h>

#include <filesystem>

#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/studies/steps/steps.hpp"
#include "experiments/text/choice.hpp"
#include "filters/scheme.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

OptionGroup steps_options() {
  return {
      "Options",
      {config_option("experiment file: beam, columns, units, window, filter (docs/configuration.md)"),
       from_to("window", "part of the record to use [s], instead of the experiment file's"),
       discretisation_option(
           "discretisation to compare with `exponential` [that of the experiment file, or forward_euler] "
           "(beamid list discretisations)")
           .repeated(),
       whole("steps", "N", 1, 8,
             "how many: dt, 2 dt, 4 dt, ...; without it, as long as 8 samples a period and 100 in all "
             "remain"),
       flag(
           "whole-model",
           "all unknowns of the experiment's model, of many degrees of freedom and under a measured force or "
           "base too, in place of K and C of one; by default where an input was measured")}};
}

OptionGroup published_options() {
  return {
      "A published value",
      {number("published-xi", "XI",
              "a damping ratio that a filter of --scheme found: what was the true one? Steps and frequency "
              "by the options below, else the record's")
           .greater_than(0)
           .less_than(1),
       text("scheme", "NAME", "the discretisation of that filter")
           .such_as(names_in(filters::scheme_registry())),
       number("interval", "S", "its steps [s]").greater_than(0),
       number("frequency", "HZ", "frequency that it found [Hz]").greater_than(0)}};
}

/// The record as identify takes it, but with its higher modes: they are the same at all steps.
IdentificationRequest steps_request(const Values& values, const fs::path& config) {
  Experiment experiment = read_experiment(config);
  require_linear_storeys(experiment, "steps");
  if (const auto window = values.from_to("window")) {
    experiment.format.window = window;
    experiment.format.window_place = {"--window"};
  }
  const fs::path file =
      require_record_files(values, config, experiment.record_file, experiment.format).front();
  IdentificationRequest one{file, std::move(experiment), {}, {}};
  one.prepared = read_and_prepare(one.file, one.experiment.format);
  try {
    cut_decay(one);
  } catch (const std::invalid_argument& error) {
    throw InputError({config.string()}, error.what());
  }
  return one;
}

StepsSettings steps_settings(const Values& values, const Experiment& experiment) {
  StepsSettings settings;
  settings.discretisations = values.texts("discretisation");
  for (const std::string& name : settings.discretisations)
    at_place({"--discretisation"}, [&] { filters::scheme_registry().find(name); });
  if (settings.discretisations.empty()) settings.discretisations = experiment.discretisations;
  if (settings.discretisations.empty())
    settings.discretisations = {
        experiment.discretisation == exact_discretisation ? "forward_euler" : experiment.discretisation};
  if (values.has("steps")) settings.steps = values.whole("steps");
  return settings;
}

/// An error of the library becomes one of the experiment file.
StepsStudy studied(const StepsSettings& settings, const IdentificationRequest& one, const fs::path& config,
                   const Progress& progress) {
  try {
    return study_steps(settings, one, config.parent_path(), progress);
  } catch (const std::invalid_argument& error) {
    throw InputError({config.string()}, error.what());
  }
}

ModelSteps model_steps(const StepsSettings& settings, const IdentificationRequest& one,
                       const fs::path& config, const Progress& progress) {
  try {
    return study_model_steps(settings, one, config.parent_path(), progress);
  } catch (const std::invalid_argument& error) {
    throw InputError({config.string()}, error.what());
  }
}

int run_record(const Values& values) {
  const fs::path config = values.text("config");
  if (config.empty()) throw UsageError("--config FILE is missing");
  for (const char* name : {"scheme", "interval", "frequency"})
    if (values.has(name)) throw UsageError(fmt::format("--{} goes with --published-xi", name));
  const IdentificationRequest one = steps_request(values, config);
  const StepsSettings settings = steps_settings(values, one.experiment);
  const bool whole_model = values.has("whole-model") || !input_channels(one.prepared.record).empty();
  return deliver(values, [&] {
    Results results = whole_model
                          ? report(one.experiment, model_steps(settings, one, config, show_progress(values)))
                          : report(one.experiment, studied(settings, one, config, show_progress(values)));
    for (const std::string& text : one.decisions()) results.paragraph(text);
    add_preparation(results, one.prepared, one.experiment.format);
    warn(results, one.experiment);
    return results;
  });
}

/// Step and frequency of the record, where they are not stated.
void take_from_record(const Values& values, PublishedDamping& published) {
  const fs::path config = values.text("config");
  const IdentificationRequest one = steps_request(values, config);
  const StepsStudy study = studied({{}, 1}, one, config, show_progress(values));
  if (!study.has_reference())
    throw InputError({config.string()}, "the record gives no frequency: " + study.steps[0].found[0].reason +
                                            "; expected --frequency");
  published.source = study.record;
  published.of_record = study.reference();
  if (!values.has("interval")) published.interval = study.steps[0].interval;
  if (!values.has("frequency")) {
    published.frequency_hz = study.reference().frequency_hz;
    published.is_true_frequency = true;
  }
}

int run_published(const Values& values) {
  for (const char* name : {"discretisation", "steps"})
    if (values.has(name)) throw UsageError(fmt::format("--{} does not go with --published-xi", name));
  if (!values.has("scheme")) throw UsageError("--published-xi of which filter? Add --scheme NAME");
  PublishedDamping published;
  published.ratio = values.number("published-xi");
  published.half_digit = half_digit_of(values.text("published-xi"));
  published.scheme = values.text("scheme");
  at_place({"--scheme"}, [&] { filters::scheme_registry().find(published.scheme); });
  if (values.has("interval")) published.interval = values.number("interval");
  if (values.has("frequency")) published.frequency_hz = values.number("frequency");
  const bool stated = values.has("interval") && values.has("frequency");
  if (!values.has("config") && (!stated || values.has("record")))
    throw UsageError(
        "--published-xi needs the filter's steps and frequency: --interval and --frequency, or a record with "
        "--config");
  return deliver(values, [&] {
    if (values.has("config")) take_from_record(values, published);
    try {
      const BehindPublished found = behind_published(published);
      return report(found);
    } catch (const std::invalid_argument& error) {
      throw UsageError(error.what());
    }
  });
}

int run_steps(const Values& values) {
  return values.has("published-xi") ? run_published(values) : run_record(values);
}

}  // namespace

Command steps_command() {
  return {
      "steps",
      "RECORD --config FILE [--discretisation NAME]... [--out DIR]",
      "one record at dt, 2 dt, 4 dt, ...: how wrong a filter's discretisation makes its damping",
      {record_argument()},
      {steps_options(), published_options(), column_options(), output_options()},
      "  beamid steps tip_acceleration.csv --config cantilever.toml --out results\n"
      "  beamid steps --config cantilever.toml --discretisation forward_euler --discretisation "
      "runge_kutta_2\n"
      "  beamid steps --config tower.toml --whole-model --discretisation forward_euler\n"
      "  beamid steps --published-xi 0.0342 --scheme forward_euler --interval 0.000605 --frequency 11.22\n"
      "  beamid steps --published-xi 0.0479 --scheme forward_euler --config cantilever.toml\n",
      run_steps,
      "",
      "3  the exact discretisation has no estimate to compare with, or no damped structure gives the "
      "published "
      "value; the first lines state why.\n"};
}

}  // namespace beamid::apps
