// What was done with a record, and what it cost, as a table, numbers and words.
#pragma once

#include <optional>
#include <string>

#include "experiments/output/results.hpp"
#include "experiments/preparation/preparation_cost.hpp"
#include "experiments/preparation/prepared_record.hpp"

namespace beamid::experiments {

/// The cost for the mode that dominates the prepared record, or why there is none.
struct DominantCost {
  std::optional<PreparationCost> cost;
  std::string reason;  ///< empty with a cost
};
DominantCost dominant_cost(const PreparedRecord& prepared, const RecordFormat& format);

/// The table `preparation`: gain, phase, transients, changes in per cent.
Table cost_table(const PreparationCost& cost);

/// One key per step with its options, and the cost; null where there is none.
nlohmann::ordered_json values(const RecordFormat& format, const DominantCost& cost);

/// Adds the remarks on the record as a paragraph; with steps, what they change together, and the values under
/// `preparation`.
void tell_preparation(Results& results, const PreparedRecord& prepared, const RecordFormat& format);

/// The same of one of several records, by its name: the sentence on the cost alone, and one more entry of the
/// array `preparations`. Nothing without steps.
void tell_cost(Results& results, const std::string& record_name, const PreparedRecord& prepared,
               const RecordFormat& format);

/// What `beamid prepare` finds: table, figure of before and after, and prepared.csv.
Results report(const PreparedRecord& prepared, const RecordFormat& format, const std::string& title,
               const std::string& record_name);

}  // namespace beamid::experiments
