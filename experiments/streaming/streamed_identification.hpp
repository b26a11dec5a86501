// Stiffness and damping while the samples arrive.
#pragma once

#include <memory>
#include <string>

#include "experiments/record_identification/record_identification.hpp"
#include "filters/running_filter.hpp"

namespace beamid::experiments {

/// K and C of a free oscillator from one sample after the other, one pass: the numbers of filter_record()
/// with passes = 1 over the same samples, to the last digit, also where they come in several parts.
///
/// A stream knows neither its noise nor its amplitude beforehand. An earlier record of the same rig gives
/// them, with the sampling interval: what prepare_identification() makes of it.
class StreamedIdentification {
 public:
  /// @throws InputError, std::invalid_argument as prepare_identification(), and where a force was measured
  StreamedIdentification(const Experiment& experiment, const Record& earlier);

  /// Outputs of a sample (p).
  Eigen::Index outputs() const { return static_cast<Eigen::Index>(names_.size()); }
  const std::vector<std::string>& names() const { return names_; }

  /// Whether the stream goes on. @throws std::invalid_argument when the stamp does not increase.
  bool take_in(const filters::Sample& sample) { return running_->take_in(sample); }
  const filters::RunningFilter& running() const { return *running_; }
  Identification found() const { return identification_at(prepared_.model, running_->belief()); }

  /// What goes on elsewhere with the same numbers: filter, state labels, sampling interval, the belief, its
  /// time and step. The divergence alarm settles anew.
  /// @throws std::invalid_argument before the first sample, and when the filter holds more than its belief.
  nlohmann::ordered_json save() const;
  /// @throws std::invalid_argument when what was saved is of another filter, model or interval.
  void resume(const nlohmann::json& saved);

 private:
  std::vector<std::string> names_;  // of the outputs
  RecordIdentification prepared_;
  Choice choice_;
  double interval_;  // [s]
  std::unique_ptr<filters::Filter> filter_;
  std::unique_ptr<filters::RunningFilter> running_;
};

/// "time_s,stiffness_n_per_m,...", and the estimates with their standard deviations after a sample, likewise.
std::string stream_header();
std::string stream_row(double time, const Identification& found);

}  // namespace beamid::experiments
