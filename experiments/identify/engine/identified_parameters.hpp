// What an identification of one record found, quantity by quantity, beside the modal analysis.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/models/estimates.hpp"
#include "filters/diagnostics.hpp"

namespace beamid::experiments {

// What a filter's run shows about itself.

/// Nothing where fewer than 100 samples were reached.
/// @param unknowns entries of the state that are parameters
std::optional<filters::Diagnostics> diagnostics_of(const filters::FilterRun& run,
                                                   const filters::Gaussian& initial,
                                                   const std::vector<Eigen::Index>& unknowns);

/// A paragraph about the first five, and how many more there were; empty when there were none.
std::string failure_sentences(const std::vector<filters::Failure>& events);

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

/// Of these four, in their order and units (4 x 4): those of K and C carried on to first order.
Eigen::Matrix4d covariance_of_parameters(const RecordIdentification& found);

/// The same of another identification of the same record, such as the batch estimate's.
std::vector<Parameter> parameters(const RecordIdentification& found, const Identification& identification);

}  // namespace beamid::experiments
