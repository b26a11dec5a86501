// What an identification of one record found, quantity by quantity, beside the modal analysis and the truth.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/unknown.hpp"
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
/// The same behind the number of samples and what decides how a filter goes on.
std::string failures_paragraph(const std::vector<filters::Failure>& events);

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

// What a parameter is in truth, where the record was simulated.

/// The mass of one degree of freedom at the record's first output, as the reduction leaves it of the beam
/// simulated [kg]; 0 where it leaves more than one coordinate, or nothing moves there.
/// @param folder in which the file of a given shape is looked for.
/// @throws as model_setting() and the reduction
double true_mass(const Experiment& truth, const Record& record, const Choice& reduction,
                 const std::filesystem::path& folder);

/// Properties of the beam are those of the beam simulated; a region's bending stiffness is its mean there,
/// damage included. K and C of one degree of freedom are those of its exact first mode, M omega_1^2 and
/// 2 xi_1 omega_1 M, with its own mass: a model that assumes another mass is wrong by as much, while that of
/// a reduction, which the assumed beam would have too, is not counted. An unknown mass is the modal mass at
/// the first output.
/// @param mass M, by true_mass() [kg]
/// @returns nothing where the beam simulated has no such quantity.
std::optional<double> true_value(const Experiment& truth, double mass, const Unknown& unknown);

}  // namespace beamid::experiments
