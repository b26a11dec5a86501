// beamid track: a stiffness that changes in time, followed through a record; no beam is needed.
#include <fmt/format.h>

#include <cmath>

#include "apps/deliver.hpp"
#include "apps/record_options.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/studies/track/report.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

options::options_description track_options() {
  options::options_description described("Options");
  described.add_options()  //
      ("band", options::value<std::vector<double>>()->multitoken()->value_name("FROM TO"),
       "frequencies between which the mode stays [Hz]; else an octave on both sides of what dominates; after "
       "RECORD")  //
      ("walk", options::value<double>()->value_name("W"),
       "relative change of the stiffness per square root of a second between changes; else what is likeliest "
       "on "
       "each plateau")  //
      ("false-alarms", options::value<double>()->value_name("P")->default_value(0.01),
       "probability of finding a change in a record that has none")  //
      ("shortest", options::value<double>()->value_name("CYCLES")->default_value(8),
       "fewest cycles of a plateau");
  return described;
}

TrackSettings settings_of(const options::variables_map& values) {
  TrackSettings settings;
  if (values.count("band")) {
    const auto& band = values["band"].as<std::vector<double>>();
    if (band.size() != 2 || !(band[0] > 0 && band[0] < band[1]))
      throw UsageError(
          "track: --band needs two frequencies above 0 [Hz], the first below the second: FROM TO");
    settings.band_hz = {band[0], band[1]};
  }
  if (values.count("walk")) settings.walk = values["walk"].as<double>();
  if (settings.walk && !(*settings.walk >= 0 && std::isfinite(*settings.walk)))
    throw UsageError(fmt::format("track: --walk is {:g}; expected a number >= 0", *settings.walk));
  settings.false_alarms = values["false-alarms"].as<double>();
  if (!(settings.false_alarms > 0 && settings.false_alarms < 1))
    throw UsageError(fmt::format("track: --false-alarms is {:g}; expected a probability above 0 and below 1",
                                 settings.false_alarms));
  settings.shortest_cycles = values["shortest"].as<double>();
  if (!(settings.shortest_cycles >= 3 && settings.shortest_cycles < 1e6))
    throw UsageError(
        fmt::format("track: --shortest is {:g}; expected 3 cycles at least", settings.shortest_cycles));
  return settings;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described = track_options();
  described.add(record_options()).add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {"record"}, values)) return 0;
  const TrackSettings settings = settings_of(values);
  const RecordRequest request = record_request(values, command.name);
  deliver(values, [&] {
    PreparedRecord prepared = read_and_prepare(request.file, request.format);
    prepared.record = made_analysable(prepared.record);
    const Record& record = prepared.record;
    const std::string file = request.file.string();
    const std::vector<Eigen::Index> outputs = output_channels(record);
    if (outputs.empty()) throw InputError({file}, "holds forces only; expected a channel of motion");
    const Eigen::Index row = outputs.front();
    const Channel& channel = record.channels[static_cast<std::size_t>(row)];
    try {
      const Tracking found = track(record.samples.row(row).transpose(), record.time[0], record.interval(),
                                   settings, show_progress());
      Results results = report(settings, record, channel, request.file.filename().string(), found);
      tell_preparation(results, prepared, request.format);
      return results;
    } catch (const std::invalid_argument& error) {
      throw InputError({file}, error.what());
    }
  });
  return 0;
}

}  // namespace

Command track_command() {
  return {"track", "RECORD [--config FILE] [--band FROM TO] [--walk W] [--out DIR]",
          "frequency and damping that change in time: plateaus, changes, history with its band",
          "  beamid track tip_acceleration.csv --out results\n"
          "  beamid track --config moving_support.toml --band 20 60 --out results\n"
          "  beamid track export.txt --column 1 --quantity acceleration --unit m/s2 --walk 0.01\n",
          run};
}

}  // namespace beamid::apps
