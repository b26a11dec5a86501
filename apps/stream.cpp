// beamid stream: samples on standard input, stiffness and damping after each on standard output.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "apps/command.hpp"
#include "experiments/diagnostics_report.hpp"
#include "experiments/failure_response.hpp"
#include "experiments/input/json_file.hpp"
#include "experiments/input/method_choice.hpp"
#include "experiments/input/read_experiment.hpp"
#include "experiments/input/spelling.hpp"
#include "experiments/model_setting.hpp"
#include "experiments/output/file.hpp"
#include "experiments/preparation/prepared_record.hpp"
#include "experiments/streaming/sample_line.hpp"
#include "experiments/streaming/streamed_identification.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

Record earlier_record(const options::variables_map& values, const Experiment& experiment,
                      const fs::path& config) {
  if (values.count("like")) return prepared_record(values["like"].as<std::string>(), experiment.format);
  if (experiment.record_file)
    return prepared_record(config.parent_path() / *experiment.record_file, experiment.format);
  throw UsageError(
      "stream: an earlier record of the rig tells noise, amplitude and sampling interval: --like "
      "RECORD, or 'file' under [record] in " +
      config.string());
}

/// Steps look ahead or wait for the record's end: no sample can be taken through them as it arrives.
void tell_preparation(const Experiment& experiment, const Record& earlier) {
  const auto& steps = experiment.format.preparation;
  if (steps.empty()) return;
  std::cerr << fmt::format(
      "The earlier record was prepared ({} step{} of [[record.prepare]]); samples are taken as they come, "
      "and expected as it is now: {}, one each {:.6g} s.\n",
      steps.size(), steps.size() > 1 ? "s" : "", joined(earlier.channel_names()), earlier.interval());
}

void resume(StreamedIdentification& stream, const std::string& file) {
  const nlohmann::json saved = read_json(file, "a state that --save-state wrote");
  try {
    stream.resume(saved);
  } catch (const std::invalid_argument& error) {
    throw InputError({file}, error.what());
  }
}

// An earlier state may be replaced, any other file may not: asked before the first sample.
void require_replaceable(const fs::path& file) {
  const fs::file_status status = fs::symlink_status(file);
  if (!fs::exists(status)) return;
  try {
    if (fs::is_regular_file(status) && read_json(file, "a state").contains("covariance")) return;
  } catch (const InputError&) {
  }
  throw UsageError("stream: " + file.string() +
                   " exists and is no state that --save-state wrote; expected another name");
}

// Beside the file first: a state is there as a whole or not at all.
void save(const StreamedIdentification& stream, const fs::path& file) {
  const fs::path part = fmt::format("{}.partial-{}", file.string(), getpid());
  fs::remove(part);  // a link there would be followed
  write_file(part, stream.save().dump(1) + "\n");
  fs::rename(part, file);
}

void follow(StreamedIdentification& stream) {
  std::cout << stream_header() << std::flush;
  std::string line;
  std::size_t told = 0;
  for (std::size_t number = 1; std::getline(std::cin, line); ++number) {
    const bool heading = number == 1 && line.starts_with("time");
    if (heading || line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Place place{"standard input", number, 1};
    const filters::Sample sample = read_sample(line, stream.outputs(), place);
    const bool goes_on = at_place(place, [&] { return stream.take_in(sample); });
    const auto& events = stream.running().events();
    for (; told < events.size(); ++told) std::cerr << words({events[told]}) << "\n";
    if (!goes_on) return;
    std::cout << stream_row(sample.time, stream.found()) << std::flush;
    if (!std::cout) return;
  }
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()  //
      ("config", options::value<std::string>()->value_name("FILE"),
       "experiment file: beam, columns, filter (docs/configuration.md)")  //
      ("like", options::value<std::string>()->value_name("RECORD"),
       "an earlier record of the rig, which tells noise, amplitude and sampling interval; default: that of "
       "the experiment file")  //
      ("on-failure", options::value<std::string>()->value_name("WHAT"),
       "when the filter fails: stop (default), inflate its covariance and go on, report and go on")    //
      ("resume", options::value<std::string>()->value_name("STATE"), "go on from a saved state")       //
      ("save-state", options::value<std::string>()->value_name("STATE"), "save the state at the end")  //
      ("help", "show this help");
  options::variables_map values;
  if (!parse(command, arguments, described, {}, values)) return 0;
  if (!values.count("config")) throw UsageError("stream: --config FILE is missing");
  const fs::path config = values["config"].as<std::string>();
  Experiment experiment = read_experiment(config);
  if (values.count("on-failure")) {
    try {
      experiment.on_failure = failure_response(values["on-failure"].as<std::string>());
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("stream: ") + error.what());
    }
  }
  const Record earlier = earlier_record(values, experiment, config);
  if (experiment.model.name != "sdof" || !experiment.parameters.empty() || !force_channels(earlier).empty())
    throw InputError(experiment.model.place.file.empty() ? Place{config.string()} : experiment.model.place,
                     "beamid stream follows model sdof without [[parameters]] in a free decay");
  StreamedIdentification stream =
      at_place({config.string()}, [&] { return StreamedIdentification(experiment, earlier); });
  tell_preparation(experiment, earlier);
  if (values.count("save-state")) require_replaceable(values["save-state"].as<std::string>());
  if (values.count("resume")) resume(stream, values["resume"].as<std::string>());
  follow(stream);
  if (!values.count("save-state")) return 0;
  if (stream.running().failure())
    std::cerr << "The filter failed, and no state was saved.\n";
  else
    save(stream, values["save-state"].as<std::string>());
  return 0;
}

}  // namespace

Command stream_command() {
  return {"stream", "--config FILE [--like RECORD] [--resume STATE] [--save-state STATE] < SAMPLES",
          "stiffness and damping while samples arrive on standard input",
          "  beamid stream --config cantilever.toml < tip_acceleration.csv\n"
          "  logger | beamid stream --config cantilever.toml --save-state now.json\n"
          "  logger | beamid stream --config cantilever.toml --resume now.json\n\n"
          "A sample is a line 'time,output[,output...]', in seconds and SI units, the outputs in the order "
          "of the\n"
          "record's channels; an output that is empty or nan was not measured. One line of estimates and\n"
          "standard deviations follows each, from one pass of the filter. [[record.prepare]] prepares the "
          "earlier\n"
          "record; samples are expected to arrive as it leaves them.\n",
          run};
}

}  // namespace beamid::apps
