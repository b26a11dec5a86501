// How well the unknowns of a model can be known at best.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/bounds/channel_information.hpp"
#include "filters/identifiability.hpp"

namespace beamid::experiments {

/// A channel that is read, and its white noise.
struct NoisyChannel {
  Eigen::Index channel = 0;
  double deviation = 0.0;  ///< per sample [unit of the channel]
};

/// What an unknown is, and the size [its unit] in which it is reckoned: the size of its value, or its
/// deviation where the value is zero.
struct UnknownSize {
  double value = 0.0;
  double size = 0.0;
  bool of_value = true;        ///< false: the size is the deviation
  double per_direction = 0.0;  ///< change of the unknown per unit of its direction, over the size
};
std::vector<UnknownSize> unknown_sizes(const ObservedMotion& motion);

/// Information of some channels about the q unknowns, each in units of its size, the start unknown. What is
/// known beforehand of nuisance parameters counts, what is guessed of the others does not.
/// @throws std::invalid_argument when a deviation is not positive.
filters::InformationFactor information_about_unknowns(const ObservedMotion& motion,
                                                      const ChannelInformation& information,
                                                      const std::vector<NoisyChannel>& channels);

/// Cramer-Rao bound on each unknown over its size, infinity where it is not determined (q).
Eigen::VectorXd relative_bounds(const filters::InformationFactor& information);

/// What the record says about one unknown.
struct ParameterBound {
  enum class Verdict {
    determined,   ///< bound below its size
    poor,         ///< bound above its size: not in practice
    combination,  ///< only together with others
    nothing       ///< no sensor shows anything of it
  };
  std::string name, unit;
  double value = 0.0;                     ///< at which the bounds hold [unit]
  double size = 0.0;                      ///< what relative numbers are relative to [unit]
  bool of_value = true;                   ///< the size is that of the value; false: its deviation beforehand
  double bound = 0.0;                     ///< on the standard deviation [unit]; infinity: not determined
  double conditional_bound = 0.0;         ///< the same were all others known [unit]
  double lower_95 = 0.0, upper_95 = 0.0;  ///< [unit]
  bool nuisance = false;
  double prior_deviation = 0.0;  ///< [unit]
  Verdict verdict = Verdict::determined;

  double bound_percent() const { return 100.0 * bound / size; }
  double conditional_percent() const { return 100.0 * conditional_bound / size; }
};
const char* to_string(ParameterBound::Verdict verdict);

/// One for each unknown. The intervals are those of the filter's state, carried through the unknown's form.
std::vector<ParameterBound> parameter_bounds(const ObservedMotion& motion,
                                             const filters::InformationReport& report);

}  // namespace beamid::experiments
