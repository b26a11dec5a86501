// Noticing at its step that innovations have left their bounds.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace beamid::filters {

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

}  // namespace beamid::filters
