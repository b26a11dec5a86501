// What `beamid reduce` prints and writes.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/results/results.hpp"
#include "experiments/studies/reduce/reduction_comparison.hpp"

namespace beamid::experiments {

/// Tables reductions, equivalents, frequency_errors, mac, and significance where a method has one; comac.csv;
/// results.json with reductions[]; figures; a mesh for ParaView of the modes of each model.
Results report(const Experiment& experiment, const std::shared_ptr<const ReductionComparison>& comparison);

/// Its parts.
Table reduction_table(const ReductionComparison& all);
Table equivalent_table(const ReductionComparison& all);
Table frequency_table(const ReductionComparison& all);
Table mac_table(const ReductionComparison& all);
Table comac_table(const ReductionComparison& all);                        ///< a row for each node
std::optional<Table> significance_table(const ReductionComparison& all);  ///< absent: no method has any
nlohmann::ordered_json values(const ReductionComparison& all);
std::vector<Figure> figures(const ReductionComparison& all);

/// A label in the names of columns and files: letters, digits and '_'.
std::string key_of(const std::string& label);

}  // namespace beamid::experiments
