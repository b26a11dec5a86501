// One-step discretisations: how a continuous model is carried over one sampling interval.
#pragma once

#include <complex>

#include "filters/continuous_model.hpp"
#include "filters/registry.hpp"

namespace beamid::filters {

/// A one-step scheme. It keeps work space, so each thread needs its own.
class Scheme {
 public:
  virtual ~Scheme() = default;

  /// z(t + dt) from z(t); `tangent` (n x n), when asked for, is d next / d state.
  /// @param input how the inputs run over the step, [p_0; ...; p_d] of StepInput: at d = 0 they are held
  /// @param next another vector than `state`
  virtual void step(const ContinuousModel& model, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                    double dt, Eigen::VectorXd& next, Eigen::MatrixXd* tangent) = 0;

  struct Amplification {
    std::complex<double> value;       ///< g(z)
    std::complex<double> derivative;  ///< g'(z)
  };
  /// Stability function g: on x' = lambda x one step multiplies x by g(lambda dt) [hairer1996, ch. IV.3].
  virtual Amplification amplification(std::complex<double> z) const = 0;
};

using SchemeRegistry = Registry<Scheme>;
SchemeRegistry& scheme_registry();

/// The lambda whose motion the scheme turns into e^(mu dt) per step: g(lambda dt) = e^(mu dt), on the branch
/// that tends to mu as dt -> 0. A filter that moves with the scheme finds this lambda in an exact record.
/// @throws std::runtime_error when Newton's method does not converge (dt too large for the scheme).
std::complex<double> seen_through(const Scheme& scheme, std::complex<double> mu, double dt);

}  // namespace beamid::filters
