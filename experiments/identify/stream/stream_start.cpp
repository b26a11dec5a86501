#include "experiments/identify/stream/stream_start.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

void require_free_motion(const Record& earlier) {
  const std::vector<Index> forces = input_channels(earlier);
  if (!forces.empty())
    throw std::invalid_argument(
        fmt::format("a stream takes free motion; found the measured force '{}', of which a band-limited path "
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

}  // namespace beamid::experiments
