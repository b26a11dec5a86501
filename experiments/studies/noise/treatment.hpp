// What a filter of one mode does with the modes it does not ask about.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "experiments/record/record.hpp"
#include "fem/beam.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

// Decaying oscillators that one sensor sees the sum of; of the first few, frequency and damping are unknown.

/// Per unit of mass: x'' + c x' + k x = w.
struct BankMember {
  double stiffness = 0.0;  ///< k = omega^2 [1/s2]
  double damping = 0.0;    ///< c = 2 xi omega [1/s]
  bool unknown = false;    ///< k and c are states; these come first
  /// Stationary standard deviation [m] of x under the white noise w: a shaping filter of coloured noise. The
  /// noise of one step is P - F P F^T with P = s^2 diag(1, k), exactly. 0: no w.
  double shaped = 0.0;
};

/// State [x1, v1, ..., xr, vr, k1, c1, ..., ku, cu]; output the sum of all x, of all v or of all v'. Each
/// pair moves by its own matrix exponential, in closed form.
/// @param variance R of the sensor
/// @throws std::invalid_argument when a member does not oscillate, or an unknown one follows a known one
std::unique_ptr<filters::DiscreteModel> oscillator_bank(const std::vector<BankMember>& members,
                                                        Quantity observed, double interval, double variance);

// What a sensor on a continuum records, mode by mode.

enum class Blow { release, hammer };

/// Modes of a beam as one point sees them: x_i = Re(a_i e^(lambda_i t)).
struct ModalMotion {
  Eigen::VectorXcd amplitude;  ///< a at the point (k) [m]
  Eigen::VectorXcd rate;       ///< lambda (k) [rad/s]

  double stiffness(Eigen::Index i) const { return std::norm(rate[i]); }   ///< K/M [1/s2]
  double damping(Eigen::Index i) const { return -2.0 * rate[i].real(); }  ///< C/M [1/s]
  double size(Eigen::Index i, Quantity observed) const;                   ///< |a lambda^n|, at t = 0
};

/// From rest in the static shape of a force at the point, or by a half-sine blow there of this duration [s];
/// the first mode moves by `deflection` [m] in both.
/// @param damping_ratios of the modes kept (k)
ModalMotion modal_motion(const fem::Beam& beam, int elements, const Eigen::VectorXd& damping_ratios,
                         Blow blow, double deflection, double blow_duration);

/// The sum of all modes, from an instant on that differs from seed to seed by up to a period of the first,
/// hence with other phases; white noise of deviation `noise` on top.
struct ModalRecord {
  double interval = 0.0;    ///< [s]
  Eigen::VectorXd samples;  ///< (N)
  Eigen::VectorXd higher;   ///< part of the modes above the first (N)
  double start = 0.0;       ///< after the blow [s]
};
ModalRecord modal_record(const ModalMotion& motion, Quantity observed, double interval, double duration,
                         double noise, std::uint64_t seed, std::uint64_t stream);

/// sensor: R is the sensor's alone; white: R is raised by their mean square; coloured: a second-order shaping
/// filter each, of known frequency, driven by white noise; filtered: a finite low-pass and fewer samples;
/// modelled: each with its own unknown stiffness and damping.
enum class Treatment { sensor, white, coloured, filtered, modelled };
inline constexpr std::array<Treatment, 5> treatments{Treatment::sensor, Treatment::white, Treatment::coloured,
                                                     Treatment::filtered, Treatment::modelled};
const char* to_string(Treatment treatment);

/// Of the first mode, relative to the truth [%]. Not finite where the filter failed.
struct FirstMode {
  double stiffness_error = 0.0, damping_error = 0.0;
  double stiffness_deviation = 0.0, damping_deviation = 0.0;  ///< as the filter says [%]
  double normalised_square = 0.0;  ///< mean innovation^2 / its variance; 1 where the filter is consistent
  double variance = 0.0;           ///< R that was used [SI]
};

/// An extended Kalman filter, exact discretisation, two passes, K and C from first guesses 3 % and 50 % off.
/// @param noise standard deviation of the sensor [SI] @param factor on the R of `sensor` and `white`
FirstMode identify_first_mode(const ModalRecord& record, const ModalMotion& motion, Quantity observed,
                              double noise, Treatment treatment, double factor = 1.0);

}  // namespace beamid::experiments
