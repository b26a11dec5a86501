// Stamps of samples: dates and times of day as loggers, spreadsheets and languages print them, columns of
// numbers that are times, and times that were rounded.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamid::experiments {

/// A date, a time of day, or both.
struct Stamp {
  enum class Kind { date, time_of_day, date_and_time };
  Kind kind = Kind::date;
  double seconds = 0.0;  ///< since 1970-01-01 without an offset or at UTC; of a time of day since midnight
  int decimals = 0;      ///< of the seconds, as printed
  int parts = -1;        ///< of the second, behind a colon: in its seconds as if decimals
};

/// Dates: 2026-11-26, 2026/11/26, 26.11.2026, 11/26/2026, 26/11/2026 (where the first number is no month),
/// 26-Nov-2026. Times of day: 9:05:07, 10:00:00.125, 10:00:00,125, 10:00:00:125, 01:00:00 PM, and 12:07.5,
/// minutes and seconds, where a fraction shows that they are; 0.125 sec and 125 ms, elapsed. Both, parted by
/// T, a blank, a comma or '_', with Z or an offset behind them; without one the stamp counts as UTC:
/// intervals do not depend on it.
/// @returns absent where the text is none
std::optional<Stamp> parse_stamp(std::string_view text);

/// How many parts behind the colon of "10:00:00:24" make a second: 1000 where they have up to three digits
/// ("10:00:00:5"), 100, or the frames of a film, by where they begin again.
/// @param seconds whole ones of each stamp; @param padded whether all have three digits or more
/// @returns absent where they are decimals, or where nothing shows it
std::optional<double> parts_of_second(const std::vector<double>& seconds, const std::vector<int>& parts,
                                      bool padded);

/// A number of as many decimals as the stamp was printed with, and of as many digits before them, for the
/// precision of a column (sampling.hpp).
std::string printed_like(const Stamp& stamp);

// Columns of numbers that may be stamps.

/// One more from row to row, from wherever it begins: no sensor does.
bool counts_rows(const std::vector<double>& values);

/// Rises and falls about zero, as no clock does.
bool swings(const std::vector<double>& values);

/// 0, 1, 2, ... or 1, 2, 3, ...: samples that are counted, no times.
bool counts_samples(const std::vector<double>& values);

/// Each above the one before it.
bool rises(const std::vector<double>& values);

/// The shortest and the longest step from one stamp to the next. @param stamps two at least
std::pair<double, double> range_of_steps(const std::vector<double>& stamps);

/// The median of the steps. @param stamps two at least
double usual_step(const std::vector<double>& stamps);

/// Rises by equal steps, to 5 %.
bool runs_evenly(const std::vector<double>& values);

/// Goes on with a counter of 32 or 16 bits, or with the seconds of a minute, that started again: numbers
/// below that range, whole ones of counters, that rise but for drops which the range makes a step like the
/// others.
/// @returns the range, where it did
std::optional<double> go_on_past_range(std::vector<double>& values);

/// 0 of fewer than two.
double mean_step(const std::vector<double>& stamps);

/// Seconds in one unit of a clock's stamps: of seconds, milliseconds, microseconds or nanoseconds since 1970,
/// by their size; of the days of a spreadsheet, or of MATLAB, by their size and that they hardly change from
/// row to row; else 1.
double seconds_of_epoch(const std::vector<double>& stamps);

// Even samples whose stamps are printed coarsely.

/// Times without the rounding of their print.
struct EvenStamps {
  std::vector<double> times;  ///< (N), as the stamps that were given
  double interval = 0.0;      ///< between neighbours, in their unit
};

/// The line t = a + n dt through all stamps, n counting samples, lost ones too, by least squares: of the
/// first and the last stamp alone, each rounded by up to half a resolution, the interval would be wrong by as
/// much over the duration, 1e-4 of 10 s printed to 1 ms. Nothing where the stamps lie on the line as they
/// are, where rounding does not explain how far they are from it (they jitter), or where it is below 2e-3
/// of an interval: 2e-6 of the rate over 1,000 samples.
/// @param times (N), increasing; @param resolution to which they are printed
std::optional<EvenStamps> without_rounding(const std::vector<double>& times, double resolution);

/// Stamps that several samples in succession share: whole seconds of a logger of 50 samples a second.
struct SharedStamps {
  double step = 0.0;                 ///< between one stamp and the next, in their unit
  std::size_t fewest = 0, most = 0;  ///< samples of a stamp, but for the first and the last, which are cut
  std::size_t whole = 0;             ///< stamps but for those two
  double mean = 0.0;                 ///< samples of such a stamp
  double first = 0.0;                ///< instant of the first sample, where the last before the second stamp
                                     ///< ends its step
  bool steady = true;                ///< every stamp is a step after the one before; else `step` is the mean

  /// Whether the samples can be counted from stamp to stamp. Few of one stamp may be those of several
  /// sensors, few stamps those of a rate that is nearly a whole number of samples.
  bool even() const { return steady && fewest == most && most >= 5 && whole >= 5; }
};

/// Nothing where stamps fall, where less than half of them are shared, or where columns repeat their numbers
/// with the stamps: rows that were written twice.
/// @param times (N); @param columns of the file, (N) each
std::optional<SharedStamps> shared_stamps(const std::vector<double>& times,
                                          const std::vector<std::vector<double>>& columns);

}  // namespace beamid::experiments
