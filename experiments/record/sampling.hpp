// Are printed times those of a regularly sampled record?
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamid::experiments {

/// How finely a column of numbers was printed: by its decimals or by its significant digits, whichever is
/// coarser.
class PrintedPrecision {
 public:
  void add(std::string_view token);

  /// That of numbers of so many significant digits: 7 in single precision, 15 in double.
  static PrintedPrecision of_digits(int digits);

  /// Distance between neighbouring printable numbers near `value`, in the column's unit.
  double resolution(double value) const;

 private:
  int decimals_ = -400, digits_ = 1;
};

/// A time that does not fit a regularly sampled record.
struct SamplingFault {
  std::size_t sample;   ///< whose time is at fault
  std::string message;  ///< what was found and what was expected
};

/// The first time that does not follow its predecessor, or does at an interval more than 5 % from the median
/// interval that the rounding of printed times does not explain. Rounding coarser than half an interval
/// explains nothing, as it would hide a missing sample. The filters take one sampling interval.
///
/// @param times as printed, in the file's unit, in which the message speaks too.
std::optional<SamplingFault> find_sampling_fault(const std::vector<double>& times,
                                                 const PrintedPrecision& precision);

/// The first time that is not after its predecessor: all that is asked of stamps at unequal intervals.
std::optional<SamplingFault> find_order_fault(const std::vector<double>& times);

}  // namespace beamid::experiments
