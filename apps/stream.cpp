// beamid stream: samples on standard input, stiffness and damping after each on standard output.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "apps/interruption.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/stream/sample_source.hpp"
#include "experiments/identify/stream/streamed_identification.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/spelling.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

Record earlier_record(const Values& values, const Experiment& experiment, const fs::path& config) {
  if (!experiment.format.own_clock.empty())
    throw UsageError("a stream comes by one clock; expected no own_clock under [record] in " +
                     config.string());
  if (values.has("like")) return prepared_record(values.text("like"), experiment.format);
  if (experiment.record_file)
    return prepared_record(config.parent_path() / *experiment.record_file, experiment.format);
  throw UsageError(
      "an earlier record of the rig determines noise, amplitude and sampling interval: --like "
      "RECORD, or 'file' under [record] in " +
      config.string());
}

/// Steps look ahead or wait for the record's end: no sample can be taken through them as it arrives.
void print_preparation(const Experiment& experiment, const Record& earlier) {
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
  throw UsageError(file.string() + " exists and is no state that --save-state wrote; expected another name");
}

void print(const std::vector<std::string>& news) {
  for (const std::string& sentence : news) std::cerr << sentence << "\n";
}

/// Until the samples end, the filter fails or nobody reads what is written; whether the filter failed.
bool follow(StreamedIdentification& stream, SampleSource& source) {
  std::cout << stream_header(stream) << std::flush;
  std::string line;
  while (source.next(line) && std::cout) {
    const bool heading = source.number() == 1 && line.starts_with("time");
    if (heading || line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Place place{"standard input", source.number(), 1};
    const filters::Sample sample = read_sample(line, stream.outputs(), place);
    const bool goes_on = at_place(place, [&] { return stream.take_in(sample); });
    print(stream.news());
    if (!goes_on) return true;
    std::cout << stream_row(sample.time, stream) << std::flush;
  }
  return false;
}

/// What a reader of the last line has to know.
void print_end(const StreamedIdentification& stream, bool failed) {
  const Eigen::Index left_out = stream.watch().left_out();
  if (left_out > 0) std::cerr << fmt::format("Outliers omitted: {}.\n", left_out);
  if (failed)
    std::cerr << "The filter failed and the stream ended there; --on-failure inflate goes on.\n";
  else if (!stream.saw_motion())
    std::cerr
        << "No parameter was determined: no motion stood out of the noise of the sensors, and the unknowns "
           "are "
           "as uncertain as at first. Excite the structure, or take the samples of a time when it moves.\n";
  else if (stream.status() == StreamedIdentification::Status::undetermined)
    std::cerr << "At the end no motion stood out of the noise: what was known before is no longer, and the "
                 "unknowns are as uncertain as at first.\n";
  else if (!stream.watch().settled() && stream.watch().starts() > 0)
    std::cerr << "The estimates had not settled at the end: they are not to be used.\n";
  else if (!stream.reliable())
    std::cerr << "The estimates are wrong as those of the earlier record are: they are not to be used.\n";
}

OptionGroup stream_options() {
  return {"Options",
          {config_option("experiment file: beam, columns, filter (docs/configuration.md)").needed(),
           text("like", "RECORD",
                "an earlier record of the rig, which gives noise, amplitude and sampling interval; without "
                "it that of the experiment file"),
           on_failure_option(), text("resume", "STATE", "go on from a saved state"),
           text("save-state", "STATE",
                "save the state at the end, whatever ends the stream: the input, a signal, a failure, a bad "
                "line")}};
}

int run_stream(const Values& values) {
  const fs::path config = values.text("config");
  Experiment experiment = read_experiment(config);
  require_linear_storeys(experiment, "stream");
  choose_failure_response(values, experiment);
  take_columns(values, experiment.format);
  const Record earlier = earlier_record(values, experiment, config);
  StreamedIdentification stream =
      at_place({config.string()}, [&] { return StreamedIdentification(experiment, earlier); });
  print(implausible(experiment));
  print_preparation(experiment, earlier);
  print(stream.news());
  if (values.has("save-state")) {
    at_place(experiment.filter.place, [&] { stream.check_can_be_saved(); });
    require_replaceable(values.text("save-state"));
    require_writable(values.text("save-state"));
  }
  if (values.has("resume")) resume(stream, values.text("resume"));
  const auto keep = [&] {
    if (values.has("save-state")) replace_file(values.text("save-state"), stream.save().dump(1) + "\n");
  };
  int signal = 0;
  bool failed = false;
  {
    SampleSource source(STDIN_FILENO);
    try {
      failed = follow(stream, source);
    } catch (...) {
      if (stream.running().step() > 0) keep();
      throw;
    }
    signal = source.signal();
    if (!(failed || signal != 0) || stream.running().step() > 0) keep();
  }
  print_end(stream, failed);
  if (signal != 0) {
    std::cout << std::flush;
    end_by(signal);
  }
  return failed ? 1 : stream.reliable() && stream.saw_motion() ? 0 : 3;
}

}  // namespace

Command stream_command() {
  return {
      "stream",
      "--config FILE [--like RECORD] [--resume STATE] [--save-state STATE] < SAMPLES",
      "stiffness, damping and other unknowns while samples arrive on standard input",
      {},
      {stream_options(), column_options()},
      "  beamid stream --config cantilever.toml < tip_acceleration.csv\n"
      "  logger | beamid stream --config cantilever.toml --save-state now.json\n"
      "  logger | beamid stream --config cantilever.toml --resume now.json\n",
      run_stream,
      "A sample is a line 'time,output[,output...]', in seconds and SI units, the outputs in the order of "
      "the "
      "record's channels; an output that is empty or nan was not measured. One line of estimates and "
      "standard deviations follows each, from one pass of the filter. Its last fields are the mean "
      "normalised square of the innovations over 50 outputs (1 where the filter is right) and the status. "
      "The status is settling, settled, undetermined (no motion stands out of the noise: the unknowns are as "
      "at first), left_out (an outlier) or begun_anew. Use estimates that have settled only: in the "
      "first example the higher modes of the release keep the filter from it until 2.4 s.\n"
      "--column, --unit and the like describe the earlier record. [[record.prepare]] prepares it; samples "
      "are expected to arrive as it yields them.\n",
      "1  the filter failed as well\n3  the earlier record, identified with this experiment, has no estimate "
      "to rely on: nor has the stream; or no motion stood out of the noise\n"};
}

}  // namespace beamid::apps
