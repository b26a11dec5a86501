// What was done with a record, and what it cost, as a table, numbers and words.
#pragma once

#include <complex>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

// What the preparation of a record does to the frequency and the damping ratio found in it.

/// Relative changes; NaN where there was nothing to fit.
struct ModalChange {
  double frequency = std::numeric_limits<double>::quiet_NaN();
  double damping_ratio = std::numeric_limits<double>::quiet_NaN();
};

/// What one step, or all together, make of the clean decay Re e^(s t).
struct StepCost {
  std::string step;    ///< "high_pass"; of all together the channel it speaks of, "displacement tip"
  bool acts = true;    ///< false: the step leaves the channel alone
  bool exact = false;  ///< factor is exact once the transients are over
  std::complex<double> factor = 1;                ///< H(s) in closed form
  std::complex<double> fitted_factor = 0;         ///< from the fit of the settled part; NaN without one
  double transient_begin = 0, transient_end = 0;  ///< [s]
  ModalChange whole;    ///< by a least-squares fit of all that is left, transients included
  ModalChange settled;  ///< by the same fit where the transients are over
  double decrement_damping = std::numeric_limits<double>::quiet_NaN();  ///< change by the decrement, of all

  double gain() const { return std::abs(factor); }
  double phase() const { return std::arg(factor); }  ///< [rad]
};

struct PreparationCost {
  double frequency_hz = 0, damping_ratio = 0;
  std::vector<StepCost> steps;     ///< each alone, sampled as the record was when it came to that step
  std::vector<StepCost> together;  ///< all in turn, of each channel that comes of the first
};

/// Runs the steps on the clean decay e^(s t), s = w (-damping_ratio + i sqrt(1 - damping_ratio^2)), and fits
/// what is left by fit_damped_sines() with a constant and by the logarithmic decrement.
///
/// The decay has the record's stamps and quantity. It begins at the event that a step cuts the record at,
/// else with the record, abruptly and at its peak: the transients are those of such a start. A cut is made
/// where it was made in the record.
/// @param record before any step; its first channel that is no force counts
/// @param window after all steps, of the fit of all together
/// @throws std::invalid_argument on a frequency that is not positive or a damping ratio outside (0, 1), and
/// what the steps throw.
PreparationCost preparation_cost(const std::vector<Choice>& steps, const Record& record, double frequency_hz,
                                 double damping_ratio,
                                 const std::optional<std::pair<double, double>>& window = {});

/// The cost for the mode that dominates the prepared record, or why there is none.
struct DominantCost {
  std::optional<PreparationCost> cost;
  std::string reason;  ///< empty with a cost
};
DominantCost dominant_cost(const PreparedRecord& prepared, const RecordFormat& format);

/// The table `preparation`: gain, phase, transients, changes in per cent.
Table cost_table(const PreparationCost& cost);

/// One key per step with its options, and the cost; null where there is none.
nlohmann::ordered_json values(const RecordFormat& format, const DominantCost& found);

/// Puts the record's warnings, those that the report has not got yet, before everything but its title and its
/// own warnings: every report that is made from a record begins with them.
/// @param record_name before each, where there are several records; may be empty
void lead_with(Results& results, const std::string& record_name, const Record& record);

/// Leads with the record's warnings, and adds the remarks on it as a paragraph; with steps, what they change
/// together, and the values under `preparation`.
void add_preparation(Results& results, const PreparedRecord& prepared, const RecordFormat& format);

/// The same of one of several records, by its name: the sentence on the cost alone, and, with steps, one more
/// entry of the array `preparations`.
void add_cost(Results& results, const std::string& record_name, const PreparedRecord& prepared,
              const RecordFormat& format);

/// What `beamid prepare` finds: table, figure of before and after, and prepared.csv.
Results report(const PreparedRecord& prepared, const RecordFormat& format, const std::string& title,
               const std::string& record_name);

}  // namespace beamid::experiments
