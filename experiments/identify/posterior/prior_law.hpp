// The prior distribution of one parameter, as a function of a standard normal number.
#pragma once

#include <optional>
#include <string>

#include "experiments/models/unknown.hpp"

namespace beamid::experiments {

/// p = F^-1(Phi(u)): a standard normal u gives a parameter distributed by F. The sampler moves in u, where
/// every prior is N(0, 1) and no bound is reached.
class PriorLaw {
 public:
  enum class Kind { normal, lognormal, uniform, log_uniform };

  /// What [[parameters]] states: `form = "logarithmic"` with a deviation is lognormal; another deviation
  /// normal, cut off at stated bounds and, of a quantity that is positive by nature, at zero; bounds alone
  /// are uniform. Of nothing stated log-uniform within assumed_factor of the initial estimate (uniform, where
  /// that is no positive number, within assumed_factor times its scale) is *assumed*.
  /// @param positive the quantity has no negative values; @param stated a deviation is
  PriorLaw(const Unknown& unknown, bool positive, bool stated);

  static constexpr double assumed_factor = 10.0;

  Kind kind() const { return kind_; }
  bool assumed() const { return assumed_; }
  std::string text() const;  ///< "uniform from 20000 to 150000"

  double value(double u) const;  ///< p
  double slope(double u) const;  ///< dp/du
  /// u of p; absent outside the prior's support, or so far in its tail that it has no probability.
  std::optional<double> place(double p) const;

 private:
  Kind kind_ = Kind::normal;
  bool assumed_ = false, cut_ = false;
  double centre_ = 0.0, spread_ = 1.0;  // of p or ln p: normal, lognormal
  double lower_, upper_;                // of p, or of ln p where log_uniform

  double standard(double u) const;  // z of a normal that is cut off
};

}  // namespace beamid::experiments
