// Other sets of parameters that explain a record as well as the one that was found.
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/twins/deciding_measurement.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// A set is decidedly likelier than another where it is twenty times likelier: -2 ln of the ratio.
inline constexpr double deciding_chi_square = 6.0;

/// One such set, at the minimum of the misfit near it.
struct RecordTwin {
  Eigen::VectorXd values;  ///< of the run's parameters, in their order and units (q)
  /// chi^2 of the record beyond that of the set found, over the square of what intervals are widened by.
  double chi_square = 0.0;
  double prior_chi_square = 0.0;  ///< likewise, of what [[parameters]] says beforehand

  /// -2 ln of its posterior density over that of the set found.
  double more() const { return chi_square + prior_chi_square; }
  /// Whether it is neither decidedly less nor decidedly more likely than the set found.
  bool is_undecided() const { return std::abs(more()) < deciding_chi_square; }
};

struct RecordTwins {
  std::vector<RecordTwin> sets;               ///< the most likely beforehand first
  std::vector<DecidingMeasurement> deciding;  ///< between all of these and the set found
  std::size_t tried = 0;                      ///< sets of the same frequencies that were held to the record

  /// The set of the highest posterior where that is decidedly higher than that of the set found; else null.
  const RecordTwin* better() const;
  std::size_t undecided() const;  ///< how many sets are
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
                         const std::filesystem::path& folder, const Progress& progress = unwatched);

/// What is reported of a record whose structure has several sets of parameters with the same frequencies.
struct LikeliestSet {
  Comparison found;
  RecordTwins twins;  ///< of the set that is reported
  std::string
      exchanged;  ///< a sentence where the search from the initial estimates ended in another set; else empty
};

/// Identifies, looks for twins, and where one of them has a decidedly higher posterior identifies again from
/// there, with prior deviations as stated. The status becomes `not_unique` where a set is left that nothing
/// decides against.
LikeliestSet likeliest_set(const Experiment& experiment, const std::filesystem::path& folder,
                           const std::function<Comparison(const Experiment&)>& identify,
                           const Progress& progress = unwatched);

}  // namespace beamid::experiments
