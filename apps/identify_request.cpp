#include "apps/identify_request.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "apps/values.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/damping_law/damping_law.hpp"
#include "experiments/identify/family/beam_family.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/studies/identify/report.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/spelling.hpp"
#include "filters/smoother.hpp"

namespace beamid::apps {

using namespace experiments;

namespace fs = std::filesystem;

Results identify_family(const Values& values, const std::vector<fs::path>& configs) {
  for (const char* other : {"damping-law", "smoother", "estimator", "window"})
    if (values.has(other)) throw UsageError(fmt::format("several --config take no --{}", other));
  const Words records = values.texts("record");
  if (!records.empty() && records.size() != configs.size())
    throw UsageError(fmt::format("{} records and {} --config; expected one record for each, in their order",
                                 records.size(), configs.size()));
  std::vector<FamilyMember> members;
  for (std::size_t k = 0; k < configs.size(); ++k) {
    FamilyMember member{
        configs[k].filename().string(), read_experiment(configs[k]), configs[k].parent_path(), {}, {}};
    require_linear_storeys(member.experiment, "a family of beams");
    const fs::path file = require_record_files(values, configs[k], member.experiment.record_file,
                                               member.experiment.format)[records.empty() ? 0 : k];
    member.record_name = file.filename().string();
    member.record = prepared_record(file, member.experiment.format);
    members.push_back(std::move(member));
  }
  const BeamFamily family = experiments::identify_family(std::move(members), show_progress(values));
  Results results = report(family);
  for (const FamilyMember& member : family.members) warn(results, member.experiment);
  return results;
}

namespace {

using Eigen::Index, Eigen::VectorXd;

/// What the command line says in place of the experiment file.
void take_words(const Values& values, Experiment& experiment) {
  if (values.has("estimator")) experiment.estimator = values.text("estimator");
  if (values.has("smoother")) experiment.smoother = values.text("smoother");
  choose_failure_response(values, experiment);
}

/// One pair of times of --window for all records, or one for each.
void take_window(const Values& values, std::size_t which, std::size_t records, Experiment& experiment) {
  if (!values.has("window")) return;
  const std::vector<double> times = values.numbers("window");
  if (times.size() != 2 && times.size() != 2 * records)
    throw UsageError(records == 1 ? "--window needs two times: FROM TO"
                                  : "--window has " + std::to_string(times.size()) + " times for " +
                                        std::to_string(records) +
                                        " records; expected FROM TO once for all, or once for each");
  const std::size_t at = times.size() == 2 ? 0 : 2 * which;
  if (!(times[at] < times[at + 1]))
    throw UsageError(
        fmt::format("--window ends at {:g}, before its start at {:g}; expected the smaller number first",
                    times[at + 1], times[at]));
  experiment.format.window = {times[at], times[at + 1]};
  experiment.format.window_place = {"--window"};
}

}  // namespace

OptionGroup identify_options() {
  Words laws = damping_laws();
  laws.insert(laws.begin(), "auto");
  Option window =
      from_to("window",
              "part of the record to use [s], instead of the experiment file's; of several records, once "
              "for all or once for each; without any, the decay behind the last hit or release");
  return {
      "Options",
      {config_option(
           "experiment file: beam, columns, units, window, filter (docs/configuration.md); once for "
           "each record: beams that share the [[parameters]] of one name, as lengths of one strip "
           "share its stiffness")
           .repeated(),
       number("mass", "KG", "without --config: the mass that moves, for stiffness and damping")
           .greater_than(0),
       window.several().repeated(), on_failure_option(),
       smoother_option("the estimates of every instant from the whole record, in smoothed.csv and a figure"),
       text("estimator", "WHICH", "filter, or both: beside it the batch estimate, all samples at once")
           .one_of({"filter", "both"})
           .by_default("filter"),
       text("damping-law", "LAW", "fit these laws to a free decay, with the evidence for each")
           .one_of(laws)}};
}

std::string damping_law(const Values& values) {
  const std::string& law = values.text("damping-law");
  if (law.empty()) return {};
  for (const char* other : {"smoother", "estimator"})
    if (values.has(other))
      throw UsageError(std::string("--damping-law fits all samples at once; expected no --") + other);
  return law;
}

namespace {

/// One mode of a record that nobody describes: its frequency and damping ratio by the modal analysis are the
/// first guess. Where the sensor drifts, the record becomes what that analysed.
/// @throws InputError where the record is no free decay of one
Experiment one_mode(const fs::path& file, PreparedRecord& prepared, const RecordFormat& format, double mass,
                    Index& channel) {
  Record& record = prepared.record;
  const auto refuse = [&](const std::string& what) {
    return InputError({file.string()},
                      what + "; `beamid modal " + file.string() +
                          "` lists the modes it has, and --config FILE describes a structure "
                          "to identify (beamid new)");
  };
  if (std::ranges::any_of(record.channels, [](const Channel& one) { return is_input(one.quantity); }))
    throw refuse("an input was measured; expected a free decay of one mode, or a structure");
  const RecordModes found =
      find_modes(file.filename().string(), made_analysable(record), format.window.has_value(), {});
  if (found.modes.empty()) throw refuse("no decaying mode was found");
  if (!found.decays) {
    if (const Objection* const one = found.objection("unexplained_motion"))
      throw refuse(
          fmt::format("modes of constant frequency and damping do not explain {:.2g} % of the motion",
                      100.0 * one->statistic));
    throw refuse("the record does not decay");
  }
  if (!found.drift.empty()) {
    Record free = found.record;
    free.remarks = std::move(record.remarks);
    free.remarks.push_back(found.drift);
    record = prepared.raw = std::move(free);
  }
  const Pole& pole = found.strongest().pole;
  VectorXd share = pole.shape.cwiseAbs();
  for (Index i = 0; i < share.size(); ++i) share[i] /= std::max(record.samples.row(i).norm(), 1e-300);
  share.maxCoeff(&channel);
  const double w = 2.0 * std::numbers::pi * pole.frequency_hz();
  Experiment experiment = read_experiment(TomlTable::parse(
      fmt::format("title = {}\n[chain]\nmasses_kg = [{:.17g}]\nstiffnesses_n_per_m = [{:.17g}]\nheights_m = "
                  "[1.0]\n[damping]\nlaw = \"modal\"\nratio = {:.17g}\n",
                  toml_string(file.filename().string()), mass, mass * w * w, pole.damping_ratio()),
      file.string()));
  experiment.format = format;
  experiment.is_described = false;
  return experiment;
}

/// The channel alone that shows the mode best: nobody says how the others move with it.
void keep_channel(Index channel, Record& record) {
  record.samples = record.samples.row(channel).eval();
  record.channels = {record.channels[static_cast<std::size_t>(channel)]};
}

std::vector<IdentifyRequest> undescribed_requests(const Values& values) {
  RecordFormat format;
  format.irregular = true;
  const std::vector<fs::path> files = record_files(values, {}, {}, format);
  if (files.empty()) throw UsageError("which RECORD? Expected a record, --config FILE, or both");
  std::vector<IdentifyRequest> requests;
  for (std::size_t r = 0; r < files.size(); ++r) {
    Experiment cut;
    cut.format = format;
    take_window(values, r, files.size(), cut);
    PreparedRecord prepared = read_and_prepare(files[r], cut.format);
    Index channel = 0;
    IdentifyRequest one{files[r], {}, {}, {}};
    try {
      one.experiment =
          one_mode(files[r], prepared, cut.format, values.has("mass") ? values.number("mass") : 1.0, channel);
      one.experiment.mass_is_stated = values.has("mass");
      take_words(values, one.experiment);
      const bool several = prepared.record.channels.size() > 1;
      const std::string name = prepared.record.channels[static_cast<std::size_t>(channel)].name;
      keep_channel(channel, prepared.record);
      keep_channel(channel, prepared.raw);
      if (several)
        prepared.record.remarks.push_back(
            fmt::format("Of the channels '{}' shows the mode best and is identified.", name));
      one.prepared = std::move(prepared);
      cut_decay(one);
      keep_out_higher_modes(one);
    } catch (const std::invalid_argument& error) {
      throw InputError({files[r].string()}, error.what());
    }
    requests.push_back(std::move(one));
  }
  return requests;
}

}  // namespace

std::vector<IdentifyRequest> identify_requests(const Values& values, const fs::path& config) {
  if (config.empty()) return undescribed_requests(values);
  if (values.has("mass")) throw UsageError("--mass is for records without --config; it states masses");
  Experiment experiment = read_experiment(config);
  take_words(values, experiment);
  const std::vector<fs::path> files =
      require_record_files(values, config, experiment.record_file, experiment.format);
  std::vector<IdentifyRequest> requests;
  for (std::size_t r = 0; r < files.size(); ++r) {
    IdentifyRequest one{files[r], experiment, {}, {}};
    take_window(values, r, files.size(), one.experiment);
    one.prepared = read_and_prepare(one.file, one.experiment.format);
    try {
      cut_decay(one);
      if (damping_law(values).empty()) keep_out_higher_modes(one);
    } catch (const std::invalid_argument& error) {
      throw InputError({config.string()}, error.what());
    }
    requests.push_back(std::move(one));
  }
  return requests;
}

}  // namespace beamid::apps
