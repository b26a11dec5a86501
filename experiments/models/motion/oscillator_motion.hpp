// One degree of freedom whose force is no linear function of its motion, with its unknowns in the state:
//
//     M x'' + F(x, x', s; p) = e f,    s' = g(x, x', s; p),    state [x, x', (s), eta, b]
//
// s is the slip of hysteretic laws, absent from the others. Observed are displacements r x, velocities r x'
// and absolute accelerations r x'' + a_base + b, r being how much of x a sensor's place has.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/models/joint_model.hpp"
#include "experiments/models/springs/spring_law.hpp"

namespace beamid::experiments {

/// F and s' at one instant, with their derivatives.
struct OscillatorForce {
  double value = 0.0, by_displacement = 0.0, by_velocity = 0.0, by_slip = 0.0;  ///< F [N]
  Eigen::VectorXd by_parameter;                                                 ///< dF/dp (k)
  double slip_rate = 0.0, slip_by_displacement = 0.0, slip_by_velocity = 0.0, slip_by_slip = 0.0;  ///< s'
  Eigen::VectorXd slip_by_parameter;  ///< ds'/dp (k); of laws that slip
};

/// F and g.
class OscillatorLaw {
 public:
  virtual ~OscillatorLaw() = default;
  virtual bool slips() const { return false; }
  /// @param parameters p in physical units, in the order of the model's terms (k)
  /// @param force its vectors have their sizes and are zero
  virtual void evaluate(double displacement, double velocity, double slip, const Eigen::VectorXd& parameters,
                        OscillatorForce& force) const = 0;
};

/// One parameter of a law: asked about or fixed.
struct OscillatorTerm {
  std::string quantity;    ///< "cubic_stiffness"
  double guess = 0.0;      ///< by the model itself [unit of the quantity]
  double deviation = 0.0;  ///< likewise
  bool always = false;     ///< asked about whatever [[parameters]] say
  bool by_itself = true;   ///< asked about where there are no [[parameters]]
  double fixed = 0.0;      ///< its value where it is not asked about
};

/// What the beam leads to expect of the oscillator.
struct ExpectedOscillator {
  double mass = 0.0, stiffness = 0.0, damping = 0.0;  ///< M [kg], K [N/m], C [N s/m] at the first output
  double amplitude = 0.0;                             ///< of a usual motion, 1 % of the beam's length [m]
};

/// @throws std::invalid_argument when the setting's reduction keeps more than one coordinate.
ExpectedOscillator expected_oscillator(const std::string& model, const ModelSetting& setting);

/// The joint model of a law; the mass is asked about too where a force was measured.
/// @param law_terms parameters of the law, in its order
/// @throws std::invalid_argument, or an InputError at a choice's place, when a choice is none of the terms or
/// something cannot be observed.
std::unique_ptr<JointModel> make_oscillator(const std::string& name, const ModelSetting& setting,
                                            std::shared_ptr<const OscillatorLaw> law,
                                            const std::vector<OscillatorTerm>& law_terms, bool sensor_bias);

// A law of springs as that of an oscillator.

/// A spring by its law, and a dashpot beside it: F = r + C x', p = [K, C, ...].
std::shared_ptr<const OscillatorLaw> spring_and_dashpot(std::shared_ptr<const SpringLaw> spring);

}  // namespace beamid::experiments
