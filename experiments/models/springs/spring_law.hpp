// The restoring force of a spring that need not be linear: of a storey of a chain, or of one coordinate.
//
//     r = r(d, h; p),    h' = g(d, d', h; p),    p = [k, p_2 .. p_k]
//
// d is the spring's elongation, for a storey its drift; h a slip, absent from springs without memory. k is
// the stiffness at rest, dr/dd at d = h = 0, so that small motion is that of a linear spring k.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/models/unknown.hpp"
#include "experiments/text/choice.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

/// Values for the parameters of one spring, in no memory of their own: at most eight.
using SpringVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1>;

/// r and g at one instant, with their derivatives.
struct SpringForce {
  double value = 0.0, by_drift = 0.0, by_slip = 0.0;                                    ///< r [N]
  SpringVector by_parameter;                                                            ///< dr/dp (k)
  double slip_rate = 0.0, slip_by_drift = 0.0, slip_by_rate = 0.0, slip_by_slip = 0.0;  ///< g [m/s]
  SpringVector slip_by_parameter;                                                       ///< dg/dp (k)

  explicit SpringForce(Eigen::Index parameters)
      : by_parameter(SpringVector::Zero(parameters)), slip_by_parameter(SpringVector::Zero(parameters)) {}
};

/// A parameter beside the stiffness, that [[parameters]] may ask about.
struct SpringParameter {
  ParameterQuantity quantity;
  double value = 0.0;  ///< as the law's options have it [unit of the quantity]

  /// Of the option that holds its value: "cubic_stiffness_n_per_m3".
  std::string key() const {
    return quantity.suffix.empty() ? quantity.name : quantity.name + "_" + quantity.suffix;
  }
};

/// The restoring force of a storey by its drift, the drift's rate and, where it slips, what has slipped; p_1
/// = k.
class SpringLaw {
 public:
  virtual ~SpringLaw() = default;
  virtual bool slips() const { return false; }
  /// p_2 .. p_k; each has an option of its key.
  virtual std::vector<SpringParameter> parameters() const { return {}; }
  /// @param parameters p in physical units (k)
  /// @throws std::runtime_error where the law has no force for these parameters
  virtual void evaluate(double drift, double rate, double slip, const SpringVector& parameters,
                        SpringForce& force) const = 0;
};

/// [k, p_2 .. p_k] with the values of the law's options.
SpringVector spring_parameters(const SpringLaw& law, double stiffness);

using SpringLawRegistry = filters::Registry<SpringLaw>;
SpringLawRegistry& spring_law_registry();

// A storey of a chain whose spring follows a law, as an experiment describes it.

/// A storey whose spring follows a law that is not linear.
struct StoreySpring {
  int storey = 1;  ///< from the lowest up
  Choice law;      ///< of spring_law_registry()
};

}  // namespace beamid::experiments
