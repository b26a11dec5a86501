// The numbers of an identification, as they stand in results.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/estimates.hpp"
#include "experiments/record_identification/record_identification.hpp"

namespace beamid::experiments {

/// One identified quantity and what the modal analysis says of it.
struct Parameter {
  const char* name;                   ///< on the terminal
  const char* key;                    ///< in results.json
  double shown;                       ///< factor to the unit of the name
  double estimate, deviation, modal;  ///< modal: NaN without a modal analysis

  double lower_95() const { return estimate - quantile_95 * deviation; }
  double upper_95() const { return estimate + quantile_95 * deviation; }
};

/// Frequency, damping ratio, stiffness and damping; deviations widened by frequency_factor() and
/// damping_factor().
std::vector<Parameter> parameters(const RecordIdentification& found);

/// The same of another identification of the same record, such as the batch estimate's.
std::vector<Parameter> parameters(const RecordIdentification& found, const Identification& identification);

/// The keys of results.json.
nlohmann::ordered_json values(const RecordIdentification& found, const Record& record);

/// All that was set, given or worked out.
nlohmann::ordered_json configuration(const Experiment& experiment, const Record& record,
                                     const RecordIdentification& found, const std::string& record_name);

}  // namespace beamid::experiments
