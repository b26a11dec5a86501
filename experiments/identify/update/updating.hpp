// The parameters of a structure from measured modes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/update/modal_residual.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

// Least squares of a residual within a box.

/// Where a search ended.
struct Fit {
  Eigen::VectorXd x;
  FitResidual::Value value;    ///< with its Jacobian
  std::vector<bool> on_bound;  ///< held there against the residual's slope
  bool converged = false;

  double chi_square() const { return value.chi_square(); }
};

/// Levenberg-Marquardt [marquardt1963] on the coordinates that are free: one on a bound that the residual
/// would push beyond it stays there. A step is at most SearchSpace::longest_step(). Points without modes
/// count as infinitely far.
/// @return nothing when there are no modes at the start.
std::optional<Fit> least_squares(const FitResidual& residual, const Eigen::VectorXd& start);

struct UpdateSettings {
  ModelTrust trust;
  int starts = 0;  ///< 0: as many as the size of the structure allows (default_starts)
};

/// A set of parameters at which the residual is smallest around it.
struct ParameterSet {
  Fit fit;
  Eigen::VectorXd values;  ///< (q) physical
  std::size_t starts = 0;  ///< that ended here
  bool as_well = false;    ///< it fits as well as the best one
  bool seeded = false;     ///< known as a twin before any search
};

/// A combination of parameters that the modes do not determine: sum_j weight_j x_j.
struct OpenDirection {
  Eigen::VectorXd weights;  ///< (q), length 1, of x = ln p, or p over its scale
  double deviation = 0.0;   ///< standard deviation of the combination; infinite where nothing changes
};

/// What the modes say of one parameter.
struct UpdatedParameter {
  double value = 0.0, deviation = 0.0, lower_95 = 0.0, upper_95 = 0.0;
  bool determined = true, on_bound = false, at_search_limit = false;
};

struct Updating {
  std::vector<ParameterSet> sets;  ///< those that fit as well first, among them the nearest to the file's
  std::vector<UpdatedParameter> parameters;  ///< of the first set (q)
  std::vector<OpenDirection> open;           ///< likewise
  Eigen::MatrixXd correlation;               ///< (q x q) of x, likewise
  std::size_t starts = 0, ended_elsewhere = 0, failed = 0;
  Eigen::Index independent = 0;  ///< numbers that were fitted
  Eigen::Index freedom = 0;      ///< those less the parameters that are determined
  double limit = 0.0;            ///< 95 % point of chi^2; 0 without freedom
  bool refuted = false;          ///< chi^2 above its 99.9 % point: more than chance
  double widening = 1.0;         ///< of the intervals, where the first set's chi^2 is above its limit
  const ParameterSet& best() const { return sets.front(); }
  bool explains() const { return widening == 1.0; }
  bool continuum() const;  ///< some combination changes nothing at all: sets are points of a continuum
  std::size_t as_well() const;
};

/// chi^2 by which a set may be worse than the best one and still fit as well: the best is exp(3) = 20 times
/// as likely.
inline constexpr double as_well_chi_square = 6.0;
/// Standard deviation of ln p, or of p over its scale, from which on it is not determined.
inline constexpr double open_deviation = 0.5;

/// Several hundred where a start takes milliseconds, fewer of large systems: the same on any machine.
int default_starts(const ModesOfParameters& model);

/// Least squares from many starts (modal_residual.hpp) and from the sets in `known`, on all cores; what they
/// end at, told apart. Deviations are those of the linearised residual at the first set, over the directions
/// that it determines; where even the best set is too far from what was measured, intervals are widened by
/// sqrt(chi^2 / freedom) and the report says so.
/// @param known values of twins (twins.hpp)
/// @throws std::invalid_argument when no start has modes.
Updating update(const FitResidual& residual, const UpdateSettings& settings,
                const std::vector<Eigen::VectorXd>& known = {}, const Progress& progress = unwatched);

}  // namespace beamid::experiments
