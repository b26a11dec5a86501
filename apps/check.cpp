// beamid check: the prediction of a structure against the modes of its records.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/description.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/model_check/model_check.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/modal/study/driven_study.hpp"
#include "experiments/modal/study/record_kind.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/studies/check/report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

/// One experiment file and the records, or the modes, of its structure.
struct Request {
  fs::path config;
  Experiment experiment;
  std::vector<fs::path> records;
};

std::vector<Request> requests_of(const Values& values) {
  const Words configs = values.texts("config"), records = values.texts("record");
  if (configs.size() > 1 && !records.empty() && records.size() != configs.size())
    throw UsageError(
        fmt::format("{} records for {} --config files; expected one for each, or one file "
                    "for all",
                    records.size(), configs.size()));
  std::vector<Request> requests;
  for (std::size_t k = 0; k < configs.size(); ++k) {
    Request request{configs[k], read_experiment(configs[k]), {}};
    require_linear_storeys(request.experiment, "check");
    request.records = require_record_files(values, request.config, request.experiment.record_file,
                                           request.experiment.format);
    if (configs.size() > 1 && !records.empty()) request.records = {request.records[k]};
    requests.push_back(std::move(request));
  }
  return requests;
}

ModalStudySettings modal_settings(const Values& values) {
  ModalStudySettings settings;
  if (values.has("method"))
    settings.method = parse_choice(values.text("method"), "--method", modal_method_registry());
  if (modal_method_registry().find(settings.method.name).contracts.contains(contract::frequency_response))
    throw UsageError("--method " + settings.method.name +
                     " needs hits with a measured force; expected era, ssi_cov or output_error");
  settings.band_hz = values.from_to("band");
  return settings;
}

/// @param decides whether the record decides on the method: from inputs that drive it, else as a free decay
RecordModes modes_of(const std::string& name, const Record& record, bool windowed,
                     const ModalStudySettings& settings, bool decides) {
  std::optional<DrivenStudy> driven;
  if (modal_method_registry().find(settings.method.name).contracts.contains(contract::measured_input))
    driven = study_driven(name, record, settings);
  if (decides && is_driven(record) && !is_struck(record)) {
    DrivenOrDecaying found = driven_or_decaying(name, record, windowed, settings);
    if (!found.driven && found.decaying) return *std::move(found.decaying);
    driven = std::move(found.driven);
  }
  if (!driven) return find_modes(name, record, windowed, settings);
  RecordModes found = modes_of(*driven);
  found.record.objections.insert(found.record.objections.end(), found.objections.begin(),
                                 found.objections.end());
  return found;
}

ModelCheckSettings check_settings(const Values& values) {
  ModelCheckSettings settings;
  settings.model_error = values.number("model-error") / 100;
  settings.shape_error = values.number("shape-error") / 100;
  settings.candidates = values.texts("candidate");
  return settings;
}

/// A record as it was taken: what its preparation costs is told with the results.
struct UsedRecord {
  std::string name;
  const RecordFormat* format;
  PreparedRecord prepared;
};

/// What a file of modes says, as update reads it.
CheckedStructure structure_of_modes(const Request& request) {
  const Experiment& experiment = request.experiment;
  if (request.records.size() > 1)
    throw InputError({request.records[1].string()},
                     "modes of one structure in several files; expected one file, or records");
  const ModalData data = read_modal_data(request.records[0], experiment);
  CheckedStructure structure{
      request.config.stem().string(), experiment.structure, experiment.elements, experiment.damping, {}};
  for (const MeasuredMode& mode : data.modes) {
    ObservedMode observed{mode.frequency_hz, mode.deviation_hz, std::nan(""), std::nan("")};
    observed.shape = mode.shape.cast<std::complex<double>>();
    observed.shape_deviation = mode.shape_deviation;
    observed.number = mode.number;
    structure.modes.push_back(std::move(observed));
  }
  if (data.has_shapes())
    for (const Sensor& sensor : experiment.sensors)
      structure.channels.push_back({Quantity::displacement, sensor.name, sensor.position, 0.0, sensor.place});
  structure.warnings = data.remarks;
  return structure;
}

/// What the records of one structure show, merged.
CheckedStructure structure_of(const Request& request, const ModalStudySettings& settings, bool decides,
                              std::vector<UsedRecord>& used) {
  if (std::any_of(request.records.begin(), request.records.end(), holds_modes))
    return structure_of_modes(request);
  std::vector<RecordModes> found;
  for (const fs::path& file : request.records) {
    const RecordFormat& format = request.experiment.format;
    used.push_back({file.filename().string(), &format, read_and_prepare(file, format)});
    try {
      Record& record = used.back().prepared.record;
      record = made_analysable(with_places(record, request.experiment));
      found.push_back(modes_of(used.back().name, record, request.experiment.format.window.has_value(),
                               settings, decides));
    } catch (const std::invalid_argument& error) {
      throw InputError({file.string()}, error.what());
    }
    if (found.back().record.channels.size() != found[0].record.channels.size())
      throw InputError({file.string()},
                       fmt::format("{} channels; expected {} as in {}", found.back().record.channels.size(),
                                   found[0].record.channels.size(), found[0].name));
  }
  CheckedStructure structure{request.config.stem().string(), request.experiment.structure,
                             request.experiment.elements,    request.experiment.damping,
                             observed_modes(found),          found[0].record.channels};
  for (const RecordModes& one : found)
    for (const experiments::Objection& objection : one.record.objections)
      structure.warnings.push_back(one.name + ": " + objection.text);
  return structure;
}

OptionGroup check_options() {
  const Words candidates{"bending_stiffness",
                         "beam_mass",
                         "free_length",
                         "tip_mass",
                         "tip_rotary_inertia",
                         "tip_offset",
                         "root_rotational_compliance",
                         "root_translational_compliance",
                         "record_clock"};
  return {
      "Options",
      {config_option("experiment file with structure and record; several, one for each record: structures "
                     "that share what is wrong with them, such as one clamp under several tip masses")
           .several()
           .repeated()
           .needed(),
       number("model-error", "PERCENT",
              "standard deviation of a predicted frequency: the error of the model [%]")
           .from(0.01)
           .up_to(20)
           .by_default("0.5"),
       number("shape-error", "PERCENT", "the same of a component of a shape, relative to the largest [%]")
           .from(0.1)
           .up_to(100)
           .by_default("3"),
       text("candidate", "NAME...",
            "what may be wrong, of a beam " + joined(candidates) +
                ", of others a group, a body, a support, a parameter; else all that the structure can have")
           .several()
           .repeated()
           .such_as(candidates),
       modal_method_option(
           "of modal analysis: era for free decays, ssi_cov for random vibration, output_error for a "
           "measured base or shaker; else era, or output_error where the record has such an input"),
       band_option("frequencies to look at [Hz]")}};
}

int run_check(const Values& values) {
  const ModalStudySettings modal = modal_settings(values);
  const ModelCheckSettings settings = check_settings(values);
  const std::vector<Request> requests = requests_of(values);
  return deliver(values, [&] {
    std::vector<CheckedStructure> structures;
    std::vector<UsedRecord> used;
    for (const Request& request : requests)
      structures.push_back(structure_of(request, modal, !values.has("method"), used));
    try {
      Results results = report(check_model(std::move(structures), settings));
      for (const Request& request : requests) {
        results.configuration["structures"].push_back({{"name", request.config.stem().string()}});
        results.configuration["structures"].back().update(describe(request.experiment));
        warn(results, request.experiment);
      }
      for (const UsedRecord& one : used) add_cost(results, one.name, one.prepared, *one.format);
      return results;
    } catch (const std::invalid_argument& error) {
      throw InputError({requests[0].config.string()}, error.what());
    }
  });
}

}  // namespace

Command check_command() {
  return {"check",
          "[RECORD...] --config FILE... [--model-error PERCENT] [--out DIR]",
          "predicted modes against those of records, and what would explain the difference",
          {record_argument(true)},
          {check_options(), column_options(), output_options()},
          "  beamid check tip_acceleration.csv --config cantilever.toml\n"
          "  beamid check run1.csv run2.csv --config cantilever.toml --model-error 1 --out results\n"
          "  beamid check light.csv heavy.csv --config light.toml heavy.toml --out results\n"
          "  beamid check modes.toml --config portal.toml\n"
          "  beamid check --config cantilever.toml --candidate tip_mass root_rotational_compliance\n",
          run_check};
}

}  // namespace beamid::apps
