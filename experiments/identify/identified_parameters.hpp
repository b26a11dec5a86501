// What an identification of one record found, quantity by quantity, beside the modal analysis.
#pragma once

#include <vector>

#include "experiments/identify/record_identification.hpp"
#include "experiments/models/estimates.hpp"

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

/// Of these four, in their order and units (4 x 4): those of K and C carried on to first order.
Eigen::Matrix4d covariance_of_parameters(const RecordIdentification& found);

/// The same of another identification of the same record, such as the batch estimate's.
std::vector<Parameter> parameters(const RecordIdentification& found, const Identification& identification);

}  // namespace beamid::experiments
