// Stiffness, damping and whatever else is asked about while the samples arrive.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "experiments/config/experiment.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/text/objection.hpp"
#include "filters/filter.hpp"
#include "filters/running_filter.hpp"

namespace beamid::experiments {

// What a stream of samples starts from: an earlier record of the same rig, or a saved state.

/// What an earlier record shows: noise and amplitude of a stream are not known beforehand.
struct StreamStart {
  JointModel model;                 ///< on the basis that the earlier record led to
  IdentificationSettings settings;  ///< of one pass; the unknowns as uncertain as before any record
  double interval_factor = 1;       ///< of deviations, for the noise near the mode; 1 at least
  bool reliable = true;  ///< whether the earlier record, identified alike, has an estimate to rely on
  std::vector<Objection> objections = {};  ///< of that identification, the worst first
};

/// Identifies the earlier record with the experiment's model, reduction and filter (identify_with_model).
/// @throws InputError, std::invalid_argument as that, and where a force was measured: its path from sample to
/// sample is known when the next one has come, not before, if it is band-limited
StreamStart stream_start(const Experiment& experiment, const Record& earlier);

// Whether a stream's readings are motion, or only noise about a constant.

/// The filter's predictions against those of a structure at rest, reading after reading:
///
///     ln Lambda = sum_k ln p(y_k | y_0 .. y_k-1, filter) - ln p(y_k | y_0 .. y_k-1, rest),
///
/// rest being a constant of every output, unknown at first, and noise. Of a structure at rest Lambda is a
/// martingale of mean 1 whatever the filter predicts, so that it ever exceeds 1 / q with probability q at
/// most [ville1939]. A filter that has learned a frequency from noise predicts no better than rest does,
/// however small the deviations that it reports.
class MotionEvidence {
 public:
  static constexpr double unlikely = 1e-15;  ///< q, as of InnovationWatch

  /// @param output y_k (p); NaN: not measured
  /// @param deviations of the noise (p)
  /// @param mean_square of the filter's innovations over what they should be; above 1 the noise is larger
  /// than stated, for both
  void take_in(const Eigen::VectorXd& output, const Eigen::VectorXd& deviations,
               const filters::Correction& correction, double mean_square);
  /// Motion has stood out of the noise since the start.
  bool seen() const { return seen_; }
  void begin_anew() { *this = {}; }

  nlohmann::ordered_json save() const;
  /// @throws nlohmann::json::exception, std::invalid_argument when it is not what save() gave
  void resume(const nlohmann::json& saved, Eigen::Index outputs);

 private:
  Eigen::VectorXd mean_, variance_;  // of every output at rest (p); variance 0: not read yet
  double evidence_ = 0.0;            // ln Lambda
  bool seen_ = false;
};

// Whether a stream's innovations look as its filter says, sample after sample.

/// Judges every sample by its normalised innovation square, chi-square of as many degrees as outputs where
/// the filter is right, and the mean over the last `window` outputs.
///
/// A filter *settles* where the window has stayed within its bound (exceeded with probability 1e-15, as by
/// filters::DivergenceAlarm) over `settling` outputs since its last start. What it learns before that may
/// come from motion that the model does not have, and is worth nothing afterwards: where the window returns
/// to its bound the filter begins anew, and where it does not return within `patience` outputs (twice as many
/// at each attempt) likewise. Once it has settled, a sample beyond the quantile 1 - 1e-12 is left out;
/// `several` of them in a row are no outliers but another motion: a hit, a release. Numbers chosen in
/// docs/theory/missing_samples.md.
class InnovationWatch {
 public:
  static constexpr Eigen::Index window = 50, settling = 200, patience = 400, most_patience = 3200,
                                several = 5;
  static constexpr Eigen::Index most_outputs = 1'000'000'000'000'000;  ///< that a saved state may have seen
  static constexpr double unlikely = 1e-15, outlying = 1e-12;

  enum class Verdict {
    keep,
    leave_out,  ///< an outlier: the prediction stands
    jumped,     ///< begin anew: `several` outliers in a row
    left,       ///< begin anew: the window has left its bound
    returned,   ///< begin anew: the window is within its bound for the first time since the start
    gave_up     ///< begin anew: the window has been out of its bound since the start
  };

  /// @param outputs that were measured; none: keep
  Verdict judge(double normalised_square, Eigen::Index outputs);

  /// The filter failed: whether it is to begin anew, as one that had been out of its bound for a window and
  /// never settled, rather than to end there.
  bool begin_anew_after_failure();

  bool settled() const { return settled_; }
  /// Normalised square per output over the window, 1 where the filter is right; NaN before the first.
  double mean_square() const;
  /// Likewise over all outputs since the filter began, or over the window, if that is more.
  double largest_mean_square() const;
  double square_at_verdict() const { return at_verdict_; }  ///< mean_square() when the filter last began anew
  Eigen::Index unsettled() const { return unsettled_; }     ///< outputs since it was settled last
  Eigen::Index left_out() const { return left_out_; }       ///< samples, in all
  Eigen::Index starts() const { return starts_; }           ///< times the filter was begun anew

  nlohmann::ordered_json save() const;
  /// @throws nlohmann::json::exception, std::invalid_argument when it is not what save() gave
  void resume(const nlohmann::json& saved);

 private:
  Verdict begin_anew(Verdict why);
  bool in_bounds() const;

  std::deque<std::pair<double, Eigen::Index>> squares_;  // of the window, with outputs
  Eigen::Index degrees_ = 0;                             // of the window
  double sum_ = 0.0, at_verdict_ = 0.0;                  // since the filter began
  Eigen::Index since_ = 0, in_bounds_ = 0, unsettled_ = 0, allowed_ = patience, in_a_row_ = 0;
  Eigen::Index left_out_ = 0, starts_ = 0;
  bool settled_ = false, was_out_ = false;
  mutable std::map<Eigen::Index, double> bounds_, gates_;  // chi-square of so many degrees
};

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
