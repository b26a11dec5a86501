// What was done with a record, and what it cost, as a table, numbers and words.
#pragma once

#include <optional>
#include <string>

#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/prepare/preparation_cost.hpp"

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
