// How finely a signal's values are resolved.
#pragma once

#include <cstddef>
#include <vector>

namespace beamid::experiments {

/// The distinct finite values of a signal and how often each occurs; values that differ by 1e-12 of the
/// largest are one, computed twice.
class ValueSteps {
 public:
  explicit ValueSteps(const std::vector<double>& signal);

  std::size_t distinct() const { return values_.size(); }
  double lowest() const { return values_.front(); }  ///< at least one distinct value
  double highest() const { return values_.back(); }

  /// The smallest difference between neighbouring ones of the sixteen values nearest in order to `value`:
  /// the converter's step there, whatever finer steps numbers printed with few digits have near zero.
  /// Infinite for fewer than two.
  double near(double value) const;

  /// How often a value of the signal occurs.
  std::size_t count(double value) const;

  /// How often the most frequent of the eight values next to `value`, an outermost one, occurs; 0 where there
  /// are fewer.
  std::size_t most_frequent_beside(double value) const;

 private:
  std::size_t place(double value) const;

  std::vector<double> values_;  ///< rising
  std::vector<std::size_t> counts_;
};

}  // namespace beamid::experiments
