// A filter as samples arrive.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "filters/filter.hpp"
#include "filters/sample_clock.hpp"

namespace beamid::filters {

// Noticing at its step that innovations have left their bounds.

/// The sum of normalised squares over the last `window` outputs that were measured, against chi-square of as
/// many degrees: diverging where a consistent filter would get there with probability 1e-15, which makes 1e-9
/// for a record of a million samples (union bound).
///
/// A joint identification from a poor guess is not consistent while it settles. So the alarm is set once the
/// window has stayed in its bounds over `settled` outputs in a row, and raised by the first that leaves
/// them; or where the filter has not settled after `patience` outputs. It is raised once, and set again when
/// the filter has settled again. How the numbers were chosen: docs/theory/missing_samples.md.
class DivergenceAlarm {
 public:
  static constexpr Eigen::Index window = 50, settled = 200, patience = 2000;
  static constexpr double probability = 1e-15;

  /// Whether the alarm is raised by a correction of that many outputs; one of none changes nothing.
  bool raised_by(double normalised_square, Eigen::Index outputs);
  /// Normalised square per output over the window; 1 when consistent.
  double mean() const { return degrees_ > 0 ? squares_.sum() / static_cast<double>(degrees_) : 0.0; }
  void clear() { *this = {}; }

 private:
  Eigen::Index oldest() const { return (next_ + window - count_) % window; }
  void forget_oldest();
  bool in_bounds();

  // The last count_ corrections, in a ring that ends before next_; the rest is zero. Summed anew each time: a
  // large square that has left must leave no rounding.
  Eigen::Array<double, window, 1> squares_ = Eigen::Array<double, window, 1>::Zero();
  std::array<Eigen::Index, window> outputs_{};
  Eigen::Index next_ = 0, count_ = 0, degrees_ = 0, in_bounds_ = 0, unsettled_ = 0;
  bool set_ = false, raised_ = false;
  std::vector<double> limits_;  // chi-square of `window` degrees and more, as far as needed; 0: not yet known
};

/// Where and why a filter failed or its innovations left their bounds.
struct Failure {
  Eigen::Index step = 0;  ///< index of the sample
  double time = 0.0;      ///< of that sample [s]
  std::string reason;
  double smallest_eigenvalue = 0.0;  ///< of the covariance that failed; NaN when none did
};

/// What a run does when its filter fails.
enum class OnFailure {
  stop,     ///< ends there. Innovations that diverge are listed, and change nothing
  inflate,  ///< goes on from the last good estimate, its covariance inflated; also where innovations diverge
  report    ///< goes on from the estimate before the measurement that it could not take, where there is one
};

/// Whether the initial estimate is about the first sample, or about one interval before it.
enum class Start { at_first_sample, one_interval_before };

/// One measurement.
struct Sample {
  double time = 0.0;                ///< [s]
  Eigen::VectorXd output;           ///< y (p); NaN: not measured
  Eigen::VectorXd input = {};       ///< how the inputs run to the next sample, as of a step; empty: none
  Eigen::VectorXd deviations = {};  ///< R = diag(squares) at this sample (p); empty: the model's own
};

/// All that a run needs to go on elsewhere with the same numbers.
struct SavedRun {
  Gaussian estimate;      ///< about the last sample, which has been taken in
  double time = 0.0;      ///< of that sample [s]
  Eigen::VectorXd input;  ///< since then
  Eigen::Index step = 0;  ///< of the sample that comes next
  DivergenceAlarm alarm;
};

/// Predicts over the interval since the last sample and corrects, sample after sample: run() is a loop over
/// it, so that a stream has the numbers of the record. Intervals are those between the stamps, told by
/// SampleClock; the model gets its own interval and noise back at the end.
///
/// Inflation multiplies the covariance by `inflation`, deviations by 10: the record then overrules what was
/// assumed, and the mean is kept as a guess. An infinite reading counts as not measured unless failures
/// stop the run.
class RunningFilter {
 public:
  static constexpr double inflation = 100.0;

  /// @param resolution of the stamps [s] @throws std::invalid_argument as SampleClock does
  explicit RunningFilter(Filter& filter, OnFailure on_failure = OnFailure::stop, double resolution = 0.0);
  ~RunningFilter();
  RunningFilter(const RunningFilter&) = delete;
  RunningFilter& operator=(const RunningFilter&) = delete;

  /// @throws std::invalid_argument when the estimate does not fit the model
  void start(const Gaussian& estimate, Start start = Start::at_first_sample);
  void resume(const SavedRun& saved);
  SavedRun save() const;

  /// move_to() and correct(); whether the run goes on.
  bool take_in(const Sample& sample);
  /// estimate() becomes that about this time, before its measurement.
  /// @throws std::invalid_argument when the stamp is not finite or does not lie after the one before.
  bool move_to(double time);
  /// estimate() becomes that after the measurement. @throws std::invalid_argument when a size does not fit.
  bool correct(const Sample& sample);

  const Gaussian& estimate() const { return filter_.estimate(); }
  const Correction& correction() const {
    return correction_;
  }                                              ///< of the last sample; empty if it told nothing
  Eigen::Index step() const { return step_; }    ///< samples taken in, from the start of the run
  double time() const { return clock_.time(); }  ///< of the last stamp [s]
  const std::vector<Failure>& events() const { return events_; }      ///< everything that went wrong
  const std::optional<Failure>& failure() const { return failure_; }  ///< what ended the run
  const Filter& filter() const { return filter_; }

 private:
  template <class Action>
  std::optional<Failure> attempt(const Action& action);
  void predict();
  void update(const Sample& sample);
  void reset(const Gaussian& estimate);
  void restart(const Gaussian& estimate);  // about the sample before, to this one
  bool go_on_without(const Failure& trouble);
  bool end(Failure failure);
  void heed_divergence();
  void drop_infinite();
  void check(const Sample& sample) const;

  Filter& filter_;
  OnFailure on_failure_;
  double regular_, interval_ = 0.0;  // of the model; that of this step, 0: none
  SampleClock clock_;
  DivergenceAlarm alarm_;
  Eigen::Index step_ = 0;
  bool first_ = true, interval_before_ = false;
  Eigen::VectorXd held_, output_;
  Correction correction_;
  Gaussian good_;  // before the step that is being taken; kept unless failures stop the run
  std::vector<Failure> events_;
  std::optional<Failure> failure_;
};

}  // namespace beamid::filters
