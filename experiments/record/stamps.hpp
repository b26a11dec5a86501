// Dates and times of day, as loggers, spreadsheets and languages print them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace beamid::experiments {

struct Stamp {
  enum class Kind { date, time_of_day, date_and_time };
  Kind kind = Kind::date;
  double seconds = 0.0;  ///< since 1970-01-01 without an offset or at UTC; of a time of day since midnight
  int decimals = 0;      ///< of the seconds, as printed
};

/// Dates: 2026-11-26, 2026/11/26, 26.11.2026, 11/26/2026, 26/11/2026 (where the first number is no month),
/// 26-Nov-2026. Times of day: 9:05:07, 10:00:00.125, 10:00:00,125, 10:00:00:125, 01:00:00 PM, and 12:07.5,
/// minutes and seconds, where a fraction shows that they are. Both, parted by T, a blank, a comma or '_',
/// with Z or an offset behind them; without one the stamp counts as UTC: intervals do not depend on it.
/// @returns absent where the text is none
std::optional<Stamp> parse_stamp(std::string_view text);

/// A number of as many decimals as the stamp was printed with, and of as many digits before them, for the
/// precision of a column (sampling.hpp).
std::string printed_like(const Stamp& stamp);

}  // namespace beamid::experiments
