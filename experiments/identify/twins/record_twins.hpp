// Other sets of parameters that explain a record as well as the one that was found.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/identify/twins/deciding_measurement.hpp"

namespace beamid::experiments {

/// One such set, at the minimum of the misfit near it.
struct RecordTwin {
  Eigen::VectorXd values;  ///< of the run's parameters, in their order and units (q)
  /// chi^2 of the record beyond that of the set found, over the square of what intervals are widened by.
  double chi_square = 0.0;
  double prior_chi_square = 0.0;  ///< likewise, of what [[parameters]] says beforehand
};

struct RecordTwins {
  std::vector<RecordTwin> sets;               ///< the most likely beforehand first
  std::vector<DecidingMeasurement> deciding;  ///< between all of these and the set found
  std::size_t tried = 0;                      ///< sets of the same frequencies that were held to the record
};

/// The sets with the frequencies of the structure that was found (twins.hpp), each moved to where it is
/// nearest to the record (output error, all samples at once, no prior) and held against the set found, moved
/// likewise. A record of one sensor in a free decay knows frequencies alone; further sensors and
/// measured inputs know of shapes.
///
/// @param comparison of one run. Without an estimate, of fewer than two stiffnesses, of more than 8 of them,
/// of a structure of more than 80 coordinates or a model of fewer coordinates than stiffnesses: no sets, none
/// tried.
/// @param folder as of compare()
RecordTwins record_twins(const Experiment& experiment, const Comparison& comparison,
                         const std::filesystem::path& folder);

}  // namespace beamid::experiments
