// What a column is, from a name as people write it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

struct RecognisedColumn {
  enum class Kind {
    time,       ///< stamps; `factor` to seconds
    count,      ///< of samples or packets: no time
    frequency,  ///< the first of a spectrum
    signal,     ///< a channel of motion or force
    other       ///< an orientation, a rate of turn, a temperature: no channel
  };
  Kind kind = Kind::signal;
  Quantity quantity = Quantity::acceleration;
  double factor = 1.0;           ///< to SI units
  bool states_quantity = false;  ///< else it is taken for an acceleration
  bool states_unit = false;      ///< else values stay as in the file
  std::string reading = {};      ///< unit of a sensor's output, "mV": no sensitivity is stated
  double least_step = 0.0;       ///< of times in the file's unit, below which the unit is not certain
};

/// "Time (s)", "t/s", "millis", "timestamp(unix)", "Zeit [s]", "acc_g", "gFx", "Linear Acceleration x
/// (m/s^2)", "Accel-Tip", "Sample", "Roll": words of six languages (English, German, French, Spanish,
/// Italian, Portuguese; time and acceleration in some more), and a unit in brackets, behind a slash, a comma
/// or an underscore, or in a row of its own.
/// @param unit that the file gives the column; empty: none
/// @returns absent where the name looks like one of this project's own with a unit that is not known
/// ("acceleration_ft_per_s2")
std::optional<RecognisedColumn> recognise_column(std::string_view name, std::string_view unit);

/// Whether a row of fields names columns: one of them at least is time or a quantity, and none is a unit
/// alone.
bool names_columns(const std::vector<std::string_view>& fields);

/// Whether a row holds units alone, one at least: "s", "[mg]", "", "-".
bool are_units(const std::vector<std::string_view>& fields);

/// The unit of motion that a line of text states for all columns: "# unit: g", "UNITS: cm/s^2",
/// "Einheit;mm/s2", "units: s, g, g", with its factor to SI units; absent where there is none, or several.
std::optional<std::pair<Quantity, double>> unit_of_statement(std::string_view lines);

/// What a number alone is by its name: "fs", "SampleRate", "sampling_frequency" are rates, "dt", "Tinterval",
/// "wf_increment" intervals.
enum class SamplingName { none, rate, interval };
SamplingName sampling_name(std::string_view name);

/// The rate that lines of text state [Hz]: "Sample rate: 400 Hz", "fs = 400", "dt = 0.0025",
/// "Sampling interval (s): 0.0025"; or a cell "Increment", "XInc", "Sample Interval", "dt:" and a number in
/// the next cell or below it. Words for it are of the six languages; a number with another unit ("fs = 10
/// V"), of another thing ("GPS rate", "trigger rate", "total sampling rate"), or of 1 Hz or less is none.
/// Absent also where two lines contradict each other, or samples were decimated.
/// @param decimal sign of the file's numbers
std::optional<double> stated_rate(std::string_view lines, char decimal = '.');

/// "Sampling rate 400 Hz", "dt=0.0025 s, N=4000", "Channels: 4": no names of columns, and no row.
bool is_statement(std::string_view line);

/// A text of one column with a decimal comma ("1,50123", "-0,01234"): as many digits follow in every line,
/// some begin with 0, and the whole numbers do not count.
bool is_column_with_commas(std::string_view text);

// Units of time, and letters without their accents, for the words above.

/// "ns", "ms", "s", "min", "h" [s]; absent: another.
std::optional<double> seconds_per_unit(std::string_view unit);

/// Small letters, without accents: "Deplacement" -> "deplacement".
std::string folded(std::string_view text);

/// Whether a unit is one of what is no motion: "lux", "MPa", "V".
bool is_other_unit(std::string_view unit);

}  // namespace beamid::experiments
