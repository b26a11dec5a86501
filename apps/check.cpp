// beamid check: the finite-element prediction against what records show.
#include <fmt/format.h>

#include <filesystem>

#include "apps/deliver.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/model_check/observed_modes.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/studies/check/report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/text/choice_text.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

/// One experiment file and the records made of its beam.
struct Request {
  fs::path config;
  Experiment experiment;
  std::vector<fs::path> records;
};

std::vector<Request> requests_of(const options::variables_map& values) {
  if (!values.count("config")) throw UsageError("check: --config FILE is missing");
  const auto configs = values["config"].as<std::vector<std::string>>();
  const auto records =
      values.count("record") ? values["record"].as<std::vector<std::string>>() : std::vector<std::string>{};
  if (configs.size() > 1 && !records.empty() && records.size() != configs.size())
    throw UsageError(
        fmt::format("check: {} records for {} --config files; expected one for each, or one file "
                    "for all",
                    records.size(), configs.size()));
  std::vector<Request> requests;
  for (std::size_t k = 0; k < configs.size(); ++k) {
    Request request{configs[k], read_experiment(configs[k]), {}};
    if (records.empty() && !request.experiment.record_file)
      throw UsageError("check: no RECORD on the command line, and no 'file' under [record] in " + configs[k]);
    if (records.empty())
      request.records = {request.config.parent_path() / *request.experiment.record_file};
    else if (configs.size() > 1)
      request.records = {records[k]};
    else
      request.records.assign(records.begin(), records.end());
    requests.push_back(std::move(request));
  }
  return requests;
}

ModalStudySettings modal_settings(const options::variables_map& values) {
  ModalStudySettings settings;
  settings.method = parse_choice(values["method"].as<std::string>(), "--method", modal_method_registry());
  if (modal_method_registry().find(settings.method.name).contracts.contains(contract::frequency_response))
    throw UsageError("check: --method " + settings.method.name +
                     " needs a measured force; expected one of motion alone, era or ssi_cov");
  if (values.count("band")) {
    const auto& band = values["band"].as<std::vector<double>>();
    if (band.size() != 2 || !(band[0] >= 0 && band[0] < band[1]))
      throw UsageError("check: --band needs two frequencies [Hz], the first below the second: FROM TO");
    settings.band_hz = {band[0], band[1]};
  }
  return settings;
}

ModelCheckSettings check_settings(const options::variables_map& values) {
  ModelCheckSettings settings;
  const double percent = values["model-error"].as<double>();
  if (!(percent >= 0.01 && percent <= 20))
    throw UsageError(fmt::format("check: --model-error is {:g}; expected 0.01 to 20 percent", percent));
  settings.model_error = percent / 100;
  if (values.count("candidate")) settings.candidates = values["candidate"].as<std::vector<std::string>>();
  return settings;
}

/// A record as it was taken: what its preparation costs is told with the results.
struct UsedRecord {
  std::string name;
  const RecordFormat* format;
  PreparedRecord prepared;
};

/// What the records of one beam show, merged.
CheckedStructure structure_of(const Request& request, const ModalStudySettings& settings,
                              std::vector<UsedRecord>& used) {
  std::vector<RecordModes> found;
  for (const fs::path& file : request.records) {
    const RecordFormat& format = request.experiment.format;
    used.push_back({file.filename().string(), &format, read_and_prepare(file, format)});
    try {
      Record& record = used.back().prepared.record;
      record = made_analysable(record);
      found.push_back(
          find_modes(used.back().name, record, request.experiment.format.window.has_value(), settings));
    } catch (const std::invalid_argument& error) {
      throw InputError({file.string()}, error.what());
    }
    if (found.back().record.channels.size() != found[0].record.channels.size())
      throw InputError({file.string()},
                       fmt::format("{} channels; expected {} as in {}", found.back().record.channels.size(),
                                   found[0].record.channels.size(), found[0].name));
  }
  CheckedStructure structure{request.config.stem().string(), request.experiment.beam,
                             request.experiment.elements,    request.experiment.damping,
                             observed_modes(found),          found[0].record.channels};
  for (const RecordModes& one : found)
    for (const std::string& warning : one.record.warnings)
      structure.warnings.push_back(one.name + ": " + warning);
  return structure;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()  //
      ("config", options::value<std::vector<std::string>>()->multitoken()->value_name("FILE..."),
       "experiment file with beam and record; several, one for each record: beams that share what is wrong "
       "with them, such as one clamp under several tip masses")  //
      ("model-error", options::value<double>()->value_name("PERCENT")->default_value(0.5),
       "what a predicted frequency is trusted to, one standard deviation [%]")  //
      ("candidate", options::value<std::vector<std::string>>()->multitoken()->value_name("NAME..."),
       "what may be wrong: bending_stiffness, beam_mass, free_length, tip_mass, tip_rotary_inertia, "
       "tip_offset, "
       "root_rotational_compliance, root_translational_compliance; else all that the beam can have")  //
      ("method", options::value<std::string>()->value_name("NAME[:OPTION=VALUE,...]")->default_value("era"),
       "of modal analysis: era for free decays, ssi_cov for random vibration")  //
      ("band", options::value<std::vector<double>>()->multitoken()->value_name("FROM TO"),
       "frequencies to look at [Hz]; after RECORD");
  described.add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {"record..."}, values)) return 0;
  const ModalStudySettings modal = modal_settings(values);
  const ModelCheckSettings settings = check_settings(values);
  const std::vector<Request> requests = requests_of(values);
  deliver(values, [&] {
    std::vector<CheckedStructure> structures;
    std::vector<UsedRecord> used;
    for (const Request& request : requests) structures.push_back(structure_of(request, modal, used));
    try {
      Results results = report(check_model(std::move(structures), settings));
      for (const Request& request : requests) warn(results, request.experiment);
      for (const UsedRecord& one : used) tell_cost(results, one.name, one.prepared, *one.format);
      return results;
    } catch (const std::invalid_argument& error) {
      throw InputError({requests[0].config.string()}, error.what());
    }
  });
  return 0;
}

}  // namespace

Command check_command() {
  return {"check", "[RECORD...] --config FILE... [--model-error PERCENT] [--out DIR]",
          "a beam's predicted modes against those of records, and what would explain the difference",
          "  beamid check tip_acceleration.csv --config cantilever.toml\n"
          "  beamid check run1.csv run2.csv --config cantilever.toml --model-error 1 --out results\n"
          "  beamid check light.csv heavy.csv --config light.toml heavy.toml --out results\n"
          "  beamid check --config cantilever.toml --candidate tip_mass root_rotational_compliance\n",
          run};
}

}  // namespace beamid::apps
