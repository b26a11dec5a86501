// Whether a stream's innovations look as its filter says, sample after sample.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

namespace beamid::experiments {

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

}  // namespace beamid::experiments
