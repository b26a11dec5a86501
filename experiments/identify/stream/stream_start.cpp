#include "experiments/identify/stream/streamed_identification.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

void require_free_motion(const Record& earlier) {
  const std::vector<Index> forces = input_channels(earlier);
  if (!forces.empty())
    throw std::invalid_argument(
        fmt::format("a stream takes free motion; found the measured input '{}', of which a band-limited path "
                    "needs the samples to come. Omit its channel, or identify a record",
                    earlier.channels[static_cast<std::size_t>(forces.front())].name));
}

}  // namespace

StreamStart stream_start(const Experiment& experiment, const Record& earlier) {
  require_free_motion(earlier);
  Experiment filtered = experiment;
  filtered.smoother.clear();
  filtered.estimator = "filter";
  filtered.noise_method = Experiment{}.noise_method;
  const Comparison found = identify_with_model(filtered, measured_record("", earlier), {}, unwatched);
  const ComparedRun& run = found.runs.at(0);
  if (run.oscillator && !found.analysis.modal_refusal.empty())
    throw std::invalid_argument(found.analysis.modal_refusal);
  if (!run.model || run.noise.size() == 0)
    throw std::invalid_argument("the earlier record is of no use to a stream: " + run.reason);
  const Record& record = found.analysis.record;
  const std::vector<Observation> observations =
      model_setting(experiment, record, experiment.reduction).observations;
  const double duration = record.interval() * static_cast<double>(record.size());
  const JointModel& model = *run.model;
  StreamStart start{model, run.settings, run.interval_factor, run.answers(), run.objections};
  start.settings.initial = initial_estimate(
      model, start_directions(model, observations,
                              start_scale(model, observations, measurements(record).outputs, duration)));
  if (start.settings.initial.covariance.size() > 0) start.settings.initial.factor.resize(0, 0);
  start.settings.passes = 1;
  return start;
}

// What a stream's identification saves, and how it goes on from there.

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Filters whose estimate is all that they carry from sample to sample.
bool carries_its_estimate_alone(const std::string& filter) {
  const auto& contracts = filters::filter_registry().find(filter).contracts;
  return contracts.contains(filters::contract::exact_on_linear_gaussian) &&
         !contracts.contains(filters::contract::sampled_on_linear_gaussian);
}

std::vector<std::string> state_names(const JointModel& model) {
  std::vector<std::string> names;
  for (const filters::Label& label : model.motion->state_labels()) names.push_back(label.name);
  return names;
}

std::vector<double> numbers(const MatrixXd& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

// Of so many rows, and columns unless they are -1: as many as there are.
MatrixXd matrix(const nlohmann::json& saved, const char* key, Index rows, Index columns) {
  const auto numbers = saved.at(key).get<std::vector<double>>();
  const auto size = static_cast<Index>(numbers.size());
  if (columns < 0 ? size % rows != 0 : size != rows * columns)
    throw std::invalid_argument(fmt::format("{} has {} numbers; expected {} rows of {}", key, size, rows,
                                            columns < 0 ? "as many" : std::to_string(columns)));
  const MatrixXd result = Eigen::Map<const MatrixXd>(numbers.data(), rows, size / rows);
  if (!result.allFinite()) throw std::invalid_argument(fmt::format("{} holds what is no number", key));
  return result;
}

// Of a state that some record has shown something of: nothing is known for certain, and nothing not at all.
void check_deviations(const char* of, const VectorXd& deviations) {
  if (!(deviations.array() > 0.0).all())
    throw std::invalid_argument(
        fmt::format("a standard deviation of {} is {:g}; expected more than 0", of, deviations.minCoeff()));
}

}  // namespace

void StreamedIdentification::check_can_be_saved() const {
  if (carries_its_estimate_alone(choice_.name)) return;
  throw std::invalid_argument("filter '" + choice_.name +
                              "' holds more than its estimate, and its state cannot be saved; ekf, iekf, "
                              "ukf, srukf and the like can");
}

nlohmann::ordered_json StreamedIdentification::save() const {
  check_can_be_saved();
  if (good_.step == 0) throw std::invalid_argument("no sample has been taken in; there is no state to save");
  auto known = nlohmann::ordered_json::array();
  for (const std::optional<Known>* one : {&older_, &newer_})
    if (*one) known.push_back({{"mean", numbers((*one)->mean)}, {"covariance", numbers((*one)->covariance)}});
  return {{"filter", choice_.name},
          {"states", state_names(prepared_.model)},
          {"interval_s", interval_},
          {"step", good_.step},
          {"time_s", good_.time},
          {"mean", numbers(good_.estimate.mean)},
          {"covariance", numbers(good_.estimate.covariance)},
          {"factor", numbers(good_.estimate.factor)},
          {"health", watch_.save()},
          {"motion", motion_.save()},
          {"saw_motion", saw_motion_},
          {"outputs_at_rest", at_rest_},
          {"outputs_since_known", remembered_},
          {"known", known}};
}

void StreamedIdentification::resume(const nlohmann::json& saved) {
  const auto check = [&](const char* key, const nlohmann::json& expected) {
    const nlohmann::json& found = saved.at(key);
    const bool short_enough =
        found.is_primitive() ||
        (found.is_array() && found.size() < 100 &&
         std::all_of(found.begin(), found.end(), [](const auto& one) { return one.is_primitive(); }));
    if (found != expected)
      throw std::invalid_argument(fmt::format(
          "{} is {}; expected {}", key, short_enough ? found.dump() : found.type_name(), expected.dump()));
  };
  try {
    check("filter", choice_.name);
    check("states", state_names(prepared_.model));
    check("interval_s", interval_);
    const auto n = static_cast<Index>(state_names(prepared_.model).size()),
               q = static_cast<Index>(prepared_.model.unknown_places.size());
    filters::SavedRun run;
    run.estimate = {matrix(saved, "mean", n, 1), matrix(saved, "covariance", n, -1),
                    matrix(saved, "factor", n, -1)};
    check_deviations("the state", run.estimate.deviations());
    run.time = saved.at("time_s").get<double>();
    constexpr Index most = InnovationWatch::most_outputs;
    run.step = whole_number(saved.at("step"), "step", 1, most);
    InnovationWatch watch;
    watch.resume(saved.at("health"));
    MotionEvidence motion;
    motion.resume(saved.at("motion"), outputs());
    std::vector<Known> known;
    for (const auto& one : saved.at("known")) {
      known.push_back({matrix(one, "mean", q, 1), matrix(one, "covariance", q, q)});
      check_deviations("known", known.back().covariance.diagonal());
    }
    if (known.size() > 2) throw std::invalid_argument("known holds more than two; expected what was saved");
    remembered_ =
        std::min<Index>(whole_number(saved.at("outputs_since_known"), "outputs_since_known", 0, most),
                        InnovationWatch::window);
    running_->resume(run);
    watch_ = watch;
    motion_ = motion;
    saw_motion_ = saved.at("saw_motion").get<bool>();
    at_rest_ = std::min<Index>(whole_number(saved.at("outputs_at_rest"), "outputs_at_rest", 0, most),
                               InnovationWatch::most_patience);
    status_ = !watch_.settled() ? Status::settling : motion_.seen() ? Status::settled : Status::undetermined;
    newer_ = known.empty() ? std::nullopt : std::optional(known.back());
    older_ = known.size() < 2 ? std::nullopt : std::optional(known.front());
    reported_ = 0;
    good_ = running_->save();
  } catch (const nlohmann::json::exception&) {
    throw std::invalid_argument("a key is missing or of another type; expected what --save-state wrote");
  }
}

}  // namespace beamid::experiments
