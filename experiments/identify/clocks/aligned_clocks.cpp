#include "experiments/identify/clocks/aligned_clocks.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/model_setting.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd;

// Of every clock, how far its channels are behind what the run makes of them [s].
Eigen::VectorXd lags_by_correlation(const Comparison& found, const std::vector<OwnClock>& clocks,
                                    double whitened) {
  const Record& record = found.analysis.record;
  const MatrixXd read = record.samples(output_channels(record), Eigen::all);
  const MatrixXd& made = found.runs.at(0).reproduced;
  Eigen::VectorXd lags(static_cast<Index>(clocks.size()));
  for (std::size_t j = 0; j < clocks.size(); ++j) {
    const std::vector<Index>& rows = clocks[j].outputs;
    const double lag =
        lag_by_correlation(read(rows, Eigen::all), made(rows, Eigen::all), record.interval(), whitened);
    lags[static_cast<Index>(j)] = clocks[j].input ? -lag : lag;
  }
  return lags;
}

// Guesses of the parameters by the channels of the common clock alone; those of the experiment where these
// fail, or where an input has another clock.
Experiment guessed_without(const std::vector<OwnClock>& clocks, const Experiment& experiment,
                           const ComparedRecord& record, const std::filesystem::path& folder,
                           const Progress& progress) {
  Experiment nearer = experiment;
  std::vector<bool> common(record.record.channels.size(), true);
  for (const OwnClock& clock : clocks) {
    if (clock.input) return nearer;
    common[static_cast<std::size_t>(clock.channel)] = false;
  }
  ComparedRecord part = record;
  part.clocks.clear();
  part.truth.reset();
  const Comparison found = identify_with_model(experiment, with_channels(part, common), folder, progress);
  const ComparedRun& run = found.runs.at(0);
  if (run.has_estimate() && run.parameters.size() == nearer.parameters.size())
    for (std::size_t j = 0; j < run.parameters.size(); ++j)
      nearer.parameters[j].guess = run.parameters[j].estimate.value;
  return nearer;
}

/// The record on one clock, and what is identified of it.
class Alignment {
 public:
  Alignment(const Experiment& experiment, const ComparedRecord& record, const std::filesystem::path& folder,
            const Progress& progress)
      : experiment_(experiment),
        folder_(folder),
        progress_(progress),
        as_read_(record.record),
        record_(record) {}

  ComparedRecord& record() { return record_; }

  Comparison identify(const Experiment& experiment) const {
    return identify_with_model(experiment, record_, folder_, progress_);
  }

  /// With all channels earlier by these lags. @returns whether the run came to its end
  bool try_lags(const Eigen::VectorXd& lags) {
    for (Index j = 0; j < lags.size(); ++j) record_.clocks[static_cast<std::size_t>(j)].lag = lags[j];
    record_.record = with_common_clock(as_read_, record_.clocks);
    record_.clocks_are_aligned = true;
    const Comparison found = identify(experiment_);
    const ComparedRun& run = found.runs.at(0);
    if (!run.clocks || run.reproduced.size() == 0) return false;
    step_ = *run.clocks;
    misfit_ = run.misfit_percent;
    for (Index j = 0; j < lags.size(); ++j)
      record_.clocks[static_cast<std::size_t>(j)].deviation = run.interval_factor * step_.deviation[j];
    return true;
  }

  const ClockStep& step() const { return step_; }
  double misfit() const { return misfit_; }

 private:
  const Experiment& experiment_;
  const std::filesystem::path& folder_;
  const Progress& progress_;
  Record as_read_;
  ComparedRecord record_;
  ClockStep step_;
  double misfit_ = 0.0;
};

// Of lags by correlations, more and less whitened, those with which the model leaves least of the record.
Eigen::VectorXd likeliest_lags(Alignment& alignment, const Comparison& apart) {
  std::optional<Eigen::VectorXd> best;
  double least = 0.0;
  for (const double whitened : {0.0, 0.5, 1.0}) {
    const Eigen::VectorXd lags = lags_by_correlation(apart, alignment.record().clocks, whitened);
    const double interval = apart.analysis.record.interval();
    if (best && ((lags - *best).array().abs() < 0.5 * interval).all()) continue;
    if (!alignment.try_lags(lags) || (best && alignment.misfit() >= least)) continue;
    best = lags;
    least = alignment.misfit();
  }
  if (best) return *best;
  throw std::invalid_argument(
      "no lag was found of the channels with clocks of their own (own_clock): with none of the lags that "
      "correlations show could the record be identified");
}

}  // namespace

ComparedRecord aligned_clocks(const Experiment& experiment, ComparedRecord record,
                              const std::filesystem::path& folder, const Progress& progress) {
  constexpr int most = 10;
  Experiment plain = experiment;
  plain.smoother.clear();
  plain.estimator = "filter";
  record.clocks = own_clocks(record.record);
  record.record.own_clock.clear();
  const Experiment nearer = guessed_without(record.clocks, plain, record, folder, progress);
  Alignment alignment(plain, record, folder, progress);
  Eigen::VectorXd lags = likeliest_lags(alignment, alignment.identify(nearer));
  for (int pass = 0; pass < most; ++pass) {
    if (!alignment.try_lags(lags)) break;
    const ClockStep& step = alignment.step();
    if ((step.lag.array().abs() <= 0.1 * step.deviation.array()).all()) return alignment.record();
    lags += step.lag;
  }
  alignment.record().notes.emplace_back(
      "The lags of the clocks have not settled: look at them before anything else.");
  return alignment.record();
}

}  // namespace beamid::experiments
