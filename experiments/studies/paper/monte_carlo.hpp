// Many seeded repetitions of one beam's test: is the printed run typical, and is the bound reached?
#pragma once

#include <array>
#include <optional>
#include <string>

#include "experiments/modal/classic_estimators.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/rig/virtual_rig.hpp"
#include "experiments/signal/integration.hpp"
#include "fem/beam.hpp"

namespace beamid::experiments::paper {

// A released beam, measured, processed and identified as one degree of freedom.

// The five beams of the 2009 paper and what is assumed about them.

struct TestBeam {
  const char* name;            ///< S(tip mass in per cent of the beam's)
  double tip_mass;             ///< [kg]
  double first_damping_ratio;  ///< ASSUMED: the paper's table is not available; "all below 0.5 %"
};

inline constexpr std::array<TestBeam, 5> test_beams{{{"S(0.65)", 0.0198575, 0.0020},
                                                     {"S(11.8)", 0.360490, 0.0045},
                                                     {"S(43.8)", 1.338090, 0.0028},
                                                     {"S(76.3)", 2.330965, 0.0022},
                                                     {"S(119.3)", 3.644615, 0.0015}}};

/// Steel, 1.10 m x 60 mm x 6 mm, 3.055 kg, E = 2.12e11 N/m2 [inverse2009].
inline fem::Cantilever steel_beam(const TestBeam& test) {
  fem::Cantilever beam;
  beam.length = 1.10;
  beam.bending_stiffness = 2.12e11 * fem::rectangle_second_moment(0.060, 0.006);
  beam.mass_per_length = 3.055 / beam.length;
  beam.tip_mass = test.tip_mass;
  return beam;
}

/// Pulled 12 mm at the tip and released; 25 s at 1000 samples/s [inverse2009].
inline Release release_of(const TestBeam& test) {
  Release release;
  release.beam = steel_beam(test);
  release.first_damping_ratio = test.first_damping_ratio;
  return release;
}

inline constexpr double sensor_noise = 0.05;  // standard deviation of the accelerometer [m/s2]

/// How acceleration becomes what the filter reads, and with what estimate it starts.
struct BeamSettings {
  double high_pass_hz = 0.0, low_pass_hz = 0.0;  ///< second order each, causal, once; 0: none
  bool zero_phase = false;                       ///< forwards and backwards instead
  double skipped = 0.0;                          ///< left out at the beginning, for the transients [s]
  double skipped_at_end = 0.0;  ///< left out at the end: zero-phase filters have transients there too
  Eigen::Vector2d noise_variance{1e-7, 1e-5};  ///< R of displacement [m2] and velocity [m2/s2]
  Eigen::Vector4d initial_variance{1e-4, 1e-1, 200.0 * 200.0, 3.0 * 3.0};  ///< P0
  double first_stiffness = 0.0;                                            ///< K0 [N/m]
  double first_damping = 0.3;                                              ///< C0 [N s/m]
  double process_variance = 0.0;  ///< Q of displacement [m2] and velocity [m2/s2], per step
};

/// A test beam with everything that does not depend on noise or filter.
struct BeamCase {
  TestBeam test;
  ReleasedBeam released;
  JointModel model;      ///< displacement and velocity observed, Rayleigh's mass (static shape)
  Oscillator reference;  ///< that mass with the exact first mode: K = Meq w1^2, C = 2 xi1 w1 Meq
  double exact_frequency_hz = 0;
  double stiffness_bound = 0, damping_bound = 0;  ///< Cramer-Rao, acceleration observed over the whole record
};
BeamCase prepare(const TestBeam& test);
/// Amplitude of the second mode's velocity at the tip after the release [m/s].
double second_mode_velocity(const BeamCase& beam);

/// The processing that reaches the bound: high-pass at f1/2, low-pass at 2.5 f1, three cycles left out.
BeamSettings tuned_settings(const BeamCase& beam);
/// The paper's: high-pass at 0.5 Hz, no low-pass, nothing left out, R = 1e-5, P0 of K and C 1e5.
BeamSettings wide_settings(const BeamCase& beam);

/// The tuned processing with zero-phase filters, three cycles left out at both ends.
BeamSettings zero_phase_settings(const BeamCase& beam);
/// The paper's settings with a zero-phase high-pass, its end transients kept.
BeamSettings zero_phase_wide_settings(const BeamCase& beam);

/// Displacement and velocity (2 x N) from an acceleration record.
filters::Measurements process(const Record& acceleration, const BeamSettings& settings);
/// The true displacement and velocity of the tip, without sensor or processing.
filters::Measurements true_motion(const BeamCase& beam);

Identification identify(const BeamCase& beam, const filters::Measurements& motion,
                        const BeamSettings& settings, const std::string& filter, const std::string& scheme);

/// Modal analysis of the acceleration: eigensystem realisation polished by least squares, and the logarithmic
/// decrement of the processed displacement beside it.
struct ReferenceAnalysis {
  ModalEstimate mode;
  DecrementEstimate decrement;
};
ReferenceAnalysis analyse(const BeamCase& beam, const Record& acceleration,
                          const filters::Measurements& motion);

/// Errors relative to the reference, over all trials.
struct TrialStatistics {
  int trials = 0;
  int diverged = 0;  ///< lost the motion; counted in the errors as they are
  double stiffness_mean_percent = 0, damping_mean_percent = 0;
  double stiffness_rms_percent = 0, damping_rms_percent = 0;
  double stiffness_bound_percent = 0, damping_bound_percent = 0;  ///< Cramer-Rao

  double damping_bound_ratio() const { return damping_rms_percent / damping_bound_percent; }
};

/// Random stream of a beam's trial; the printed run is trial 0.
std::uint64_t stream_of(int beam, int trial);

/// EKF with the exact discretisation on the tuned processing; the result does not depend on the number of
/// threads.
TrialStatistics repeat(const BeamCase& beam, int beam_number, int trials, std::uint64_t seed);

}  // namespace beamid::experiments::paper
