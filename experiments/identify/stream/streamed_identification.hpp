// Stiffness, damping and whatever else is asked about while the samples arrive.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/stream/innovation_watch.hpp"
#include "experiments/identify/stream/motion_evidence.hpp"
#include "experiments/identify/stream/stream_start.hpp"
#include "filters/running_filter.hpp"

namespace beamid::experiments {

/// The unknowns of any model from one sample of free motion after the other, one pass: the numbers of
/// filter_record() with passes = 1 over the same samples, to the last digit, also where they come in several
/// parts, as long as the innovations agree with the filter.
///
/// Where they do not (InnovationWatch), outliers are left out, and the filter begins anew: its motion as
/// unknown as at first, the unknowns as they were known some 50 outputs before, at a time when the
/// innovations agreed; or, before there was such a time and where those of then do not fit for 2000 outputs,
/// as uncertain as at first.
///
/// Innovations of a structure at rest agree with any filter, and a filter learns frequencies from their
/// noise: as long as no motion stands out of it (MotionEvidence), nothing is determined, and nothing kept.
class StreamedIdentification {
 public:
  static constexpr Eigen::Index forget_after = 2000;  ///< outputs that the unknowns of before do not fit

  /// What became of the last sample.
  enum class Status {
    settling,      ///< taken in; the innovations have not yet agreed with the filter for 200 outputs
    settled,       ///< taken in; they have
    undetermined,  ///< taken in; they have, and are no motion: the unknowns are as at first
    left_out,      ///< an outlier
    begun_anew     ///< the filter begins anew behind it
  };

  /// @throws InputError, std::invalid_argument as stream_start()
  StreamedIdentification(const Experiment& experiment, const Record& earlier);

  /// Whether model, discretisation and noise are right for the earlier record: news() begins with what is
  /// not.
  bool reliable() const { return prepared_.reliable; }

  /// Outputs of a sample (p).
  Eigen::Index outputs() const { return static_cast<Eigen::Index>(names_.size()); }
  const std::vector<std::string>& names() const { return names_; }

  /// Whether the stream goes on. @throws std::invalid_argument when the stamp does not increase.
  bool take_in(const filters::Sample& sample);
  const filters::RunningFilter& running() const { return *running_; }
  Status status() const { return status_; }
  const InnovationWatch& watch() const { return watch_; }
  /// Whether motion stood out of the noise at any time.
  bool saw_motion() const { return saw_motion_; }
  /// A sentence for everything that happened since the last call.
  std::vector<std::string> news();

  /// A quantity that rows show.
  struct Shown {
    std::string name, unit;
    double value = 0, deviation = 0;  ///< [unit]
  };
  /// The model's unknowns; of K and C of one degree of freedom also frequency and damping ratio.
  std::vector<Shown> shown() const;
  /// Of the deviations in shown(): noise near the mode of the earlier record, and innovations that are larger
  /// than the noise says; at least 1.
  double interval_factor() const;

  /// @throws std::invalid_argument when the filter holds more than its estimate
  void check_can_be_saved() const;
  /// What goes on elsewhere with the same numbers, about the last sample that did not end the stream: filter,
  /// state labels, sampling interval, the estimate, its time and step, and the health of its innovations.
  /// @throws std::invalid_argument before the first sample, and when the filter holds more than its estimate.
  nlohmann::ordered_json save() const;
  /// @throws std::invalid_argument when what was saved is of another filter, model or interval, or is none
  /// that a filter can have: a variance that is not above 0, a step that is no count.
  void resume(const nlohmann::json& saved);

 private:
  /// Mean and covariance of the unknowns, at a time when the innovations agreed.
  struct Known {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };

  void list_failures();
  void heed(const filters::Sample& sample, const filters::Gaussian& predicted);
  void begin_anew(InnovationWatch::Verdict why);
  Known known_now() const;
  filters::Gaussian first_estimate(const Known& unknowns) const;
  Known at_first() const;

  std::vector<std::string> names_;  // of the outputs
  StreamStart prepared_;
  Choice choice_;
  double interval_;  // [s]
  std::unique_ptr<filters::Filter> filter_;
  std::unique_ptr<filters::RunningFilter> running_;
  InnovationWatch watch_;
  MotionEvidence motion_;
  bool saw_motion_ = false;
  Eigen::Index at_rest_ = 0;  // outputs that agreed and were no motion, since the last start
  Status status_ = Status::settling;
  std::optional<Known> older_, newer_;  // at least one window old, and at most
  Eigen::Index remembered_ = 0;         // outputs since newer_
  filters::SavedRun good_;              // after the last sample that did not end the stream
  std::size_t reported_ = 0;            // events of running_
  std::vector<std::string> news_;
};

/// "time_s,stiffness_n_per_m,...", and the estimates with their standard deviations after a sample, likewise;
/// at the end the mean normalised innovation square and the status.
std::string stream_header(const StreamedIdentification& stream);
std::string stream_row(double time, const StreamedIdentification& stream);

/// "settling", "settled", "undetermined", "left_out", "begun_anew"
const char* word(StreamedIdentification::Status status);

}  // namespace beamid::experiments
