// beamid track: a stiffness that changes in time, followed through a record; no beam is needed.
#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/modal/study/driven_study.hpp"
#include "experiments/modal/study/record_kind.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/studies/track/report.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

OptionGroup track_options() {
  return {
      "Options",
      {band_option("frequencies between which the mode stays [Hz]; else an octave on both sides of what "
                   "dominates"),
       number("walk", "W",
              "relative change of the stiffness per square root of a second between changes; else what is "
              "likeliest on each plateau")
           .from(0),
       number("false-alarms", "P", "probability of finding a change in a record that has none")
           .greater_than(0)
           .less_than(1)
           .by_default("0.01"),
       number("shortest", "CYCLES", "fewest cycles of a plateau").from(3).less_than(1e6).by_default("8")}};
}

TrackSettings track_settings_of(const Values& values) {
  TrackSettings settings;
  settings.band_hz = values.from_to("band");
  if (values.has("walk")) settings.walk = values.number("walk");
  settings.false_alarms = values.number("false-alarms");
  settings.shortest_cycles = values.number("shortest");
  return settings;
}

int run_track(const Values& values) {
  const TrackSettings settings = track_settings_of(values);
  const RecordRequest request = record_requests(values).front();
  return deliver(values, [&] {
    PreparedRecord prepared = read_and_prepare(request.file, request.format);
    prepared.record = made_analysable(prepared.record);
    if (request.format.channels.empty()) put_strongest_first(prepared.record);
    const Record& record = prepared.record;
    const std::string file = request.file.string();
    const std::vector<Eigen::Index> outputs = output_channels(record);
    if (outputs.empty()) throw InputError({file}, "holds forces only; expected a channel of motion");
    refuse_driven(file, record, request.format.window.has_value());
    const Eigen::Index row = outputs.front();
    const Channel& channel = record.channels[static_cast<std::size_t>(row)];
    try {
      const Tracking found = track(record.samples.row(row).transpose(), record.time[0], record.interval(),
                                   settings, show_progress(values));
      Results results = report(settings, record, channel, request.file.filename().string(), found);
      add_preparation(results, prepared, request.format);
      return results;
    } catch (const std::invalid_argument& error) {
      throw InputError({file}, error.what());
    }
  });
}

}  // namespace

Command track_command() {
  return {"track",
          "RECORD [--config FILE] [--band FROM TO] [--walk W] [--out DIR]",
          "frequency and damping that change in time: plateaus, changes, history with its band",
          {record_argument()},
          {track_options(), record_options(), output_options()},
          "  beamid track tip_acceleration.csv --out results\n"
          "  beamid track --config moving_support.toml --band 20 60 --out results\n"
          "  beamid track export.txt --column 1 --quantity acceleration --unit m/s2 --walk 0.01\n",
          run_track};
}

}  // namespace beamid::apps
