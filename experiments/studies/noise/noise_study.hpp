// When may a filter of one mode take the others for noise? Treatments of the others, and seeded trials.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/record/record.hpp"
#include "experiments/text/progress.hpp"
#include "fem/beam.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

// What a filter of one mode does with the modes it does not ask about.

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

struct NoiseBeam {
  std::string name;
  fem::Beam beam;
  double tip_mass_percent = 0.0;   ///< of the beam's own
  Eigen::VectorXd damping_ratios;  ///< of the modes (k), those kept being the first of them
};

struct NoiseSettings {
  std::vector<NoiseBeam> beams;
  int elements = 40;
  int modes = 3;              ///< kept in the records
  int trials = 6;             ///< per case
  double noise = 0.001;       ///< of the sensor, relative to the first mode's amplitude in what it observes
  double deflection = 0.012;  ///< of the first mode [m]
  double blow = 0.005;        ///< duration of the hammer's half sine [s]
  double interval = 0.004;    ///< [s]
  double duration = 8.0;      ///< [s]
  std::uint64_t seed = 2009;
  std::vector<double> factors{1e-2, 1e2};  ///< on R of `white`, tried beside 1
};

/// Over the trials of one case that were not lost; errors relative to the truth.
struct NoiseStatistics {
  double stiffness_mean_percent = 0.0, damping_mean_percent = 0.0;
  double stiffness_rms_percent = 0.0, damping_rms_percent = 0.0;
  double stiffness_ratio = 0.0, damping_ratio = 0.0;  ///< rms error over the deviation reported
  double normalised_square = 0.0;                     ///< mean of all that ended; 1 where consistent
  int failed = 0;  ///< trials lost: the filter failed, or K is 5 % off or more, or C 100 %
};

struct NoiseCase {
  std::size_t beam = 0;
  Blow blow = Blow::release;
  Quantity observed = Quantity::acceleration;
  int modes = 1;
  double share = 0.0;                       ///< rms of the higher modes over that of the first, at the start
  std::vector<NoiseStatistics> treatments;  ///< in the order of `treatments`
  std::vector<NoiseStatistics> factors;     ///< `white` with R times each of the factors
  double best_factor = 1.0;                 ///< the one with the least rms error of C

  const NoiseStatistics& by(Treatment treatment) const {
    return treatments[static_cast<std::size_t>(treatment)];
  }
  const NoiseStatistics& best(const NoiseSettings& settings) const;
};

struct NoiseStudy {
  NoiseSettings settings;
  std::vector<NoiseCase> cases;  ///< every beam, blow and sensor
  std::vector<NoiseCase> kept;   ///< the first beam's release again, with 1, 2, ... modes
};

/// The statistics of one case; its numbers do not depend on the other cases or the number of threads.
NoiseCase examine(const NoiseSettings& settings, std::size_t beam, Blow blow, Quantity observed, int modes);

/// Whether the other modes may be taken for noise: C within 1 % (rms), and that error within three
/// of the deviations reported.
bool harmless(const NoiseStatistics& statistics);

/// @throws std::invalid_argument when the settings are impossible
NoiseStudy study_higher_modes(const NoiseSettings& settings, const Progress& progress);

}  // namespace beamid::experiments
