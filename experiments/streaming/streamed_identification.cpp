#include "experiments/streaming/streamed_identification.hpp"

#include <fmt/format.h>

#include <cmath>

#include "experiments/input/method_choice.hpp"
#include "experiments/model_setting.hpp"
#include "experiments/output/csv.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Filters whose belief is all that they carry from sample to sample.
bool carries_its_belief_alone(const std::string& filter) {
  const auto& contracts = filters::filter_registry().find(filter).contracts;
  return contracts.contains(filters::contract::exact_on_linear_gaussian) &&
         !contracts.contains(filters::contract::sampled_on_linear_gaussian);
}

// The path of a force from sample to sample is known when the next one has come: not before, if it is
// band-limited.
std::vector<std::string> names_of_free_motion(const Record& earlier) {
  const std::vector<Index> forces = force_channels(earlier);
  if (!forces.empty())
    throw std::invalid_argument(
        fmt::format("a stream takes free motion; found the measured force '{}', of which a band-limited path "
                    "needs the samples to come. Leave its channel out, or identify a record",
                    earlier.channels[static_cast<std::size_t>(forces.front())].name));
  return earlier.channel_names();
}

std::vector<std::string> state_names(const JointModel& model) {
  std::vector<std::string> names;
  for (const filters::Label& label : model.motion->state_labels()) names.push_back(label.name);
  return names;
}

std::vector<double> numbers(const MatrixXd& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

MatrixXd matrix(const nlohmann::json& saved, const char* key, Index rows, Index columns) {
  const auto numbers = saved.at(key).get<std::vector<double>>();
  const auto size = static_cast<Index>(numbers.size());
  if (size != rows * columns)
    throw std::invalid_argument(fmt::format("{} has {} numbers; expected {} x {}", key, size, rows, columns));
  return Eigen::Map<const MatrixXd>(numbers.data(), rows, columns);
}

}  // namespace

StreamedIdentification::StreamedIdentification(const Experiment& experiment, const Record& earlier)
    : names_(names_of_free_motion(earlier)),
      prepared_(prepare_identification(experiment, earlier)),
      choice_(experiment.filter),
      interval_(earlier.interval()) {
  const auto& settings = prepared_.settings;
  filter_ = at_place(choice_.place, [&] {
    return filters::filter_registry().make(
        settings.filter, settings.filter_options,
        filters::discretise(prepared_.model.motion, interval_, settings.discretisation,
                            {{}, settings.output_noise}));
  });
  running_ = std::make_unique<filters::RunningFilter>(*filter_, settings.on_failure,
                                                      measurements(earlier).time_resolution);
  running_->start(settings.initial, settings.start);
}

nlohmann::ordered_json StreamedIdentification::save() const {
  if (!carries_its_belief_alone(choice_.name))
    throw std::invalid_argument(
        "filter '" + choice_.name +
        "' holds more than its belief, and its state cannot be saved; ekf, iekf, ukf, "
        "srukf and the like can");
  if (running_->step() == 0) throw std::invalid_argument("no sample has been taken in; nothing to save");
  const filters::SavedRun saved = running_->save();
  return {{"filter", choice_.name},
          {"states", state_names(prepared_.model)},
          {"interval_s", interval_},
          {"step", saved.step},
          {"time_s", saved.time},
          {"mean", numbers(saved.belief.mean)},
          {"covariance", numbers(saved.belief.covariance)},
          {"factor", numbers(saved.belief.factor)}};
}

void StreamedIdentification::resume(const nlohmann::json& saved) {
  const auto check = [&](const char* key, const nlohmann::json& expected) {
    if (saved.at(key) != expected)
      throw std::invalid_argument(
          fmt::format("{} is {}; expected {}", key, saved.at(key).dump(), expected.dump()));
  };
  try {
    check("filter", choice_.name);
    check("states", state_names(prepared_.model));
    check("interval_s", interval_);
    const auto n = static_cast<Index>(state_names(prepared_.model).size());
    filters::SavedRun run;
    const Index of_factor = saved.at("factor").empty() ? 0 : n;  // not every filter keeps one
    run.belief = {matrix(saved, "mean", n, 1), matrix(saved, "covariance", n, n),
                  matrix(saved, "factor", n, of_factor)};
    run.time = saved.at("time_s").get<double>();
    run.step = saved.at("step").get<Index>();
    running_->resume(run);
  } catch (const nlohmann::json::exception&) {
    throw std::invalid_argument("a key is missing or of another type; expected what --save-state wrote");
  }
}

std::string stream_header() {
  return "time_s,stiffness_n_per_m,stiffness_deviation_n_per_m,damping_n_s_per_m,damping_deviation_n_s_per_m,"
         "frequency_hz,frequency_deviation_hz,damping_ratio,damping_ratio_deviation\n";
}

std::string stream_row(double time, const Identification& found) {
  std::string row = csv_field(time);
  for (const double number :
       {found.found.stiffness, found.stiffness_deviation, found.found.damping, found.damping_deviation,
        found.found.frequency_hz(), found.frequency_deviation_hz, found.found.damping_ratio(),
        found.damping_ratio_deviation})
    row += "," + csv_field(number);
  return row + "\n";
}

}  // namespace beamid::experiments
