// Who is to blame: the error of a pipeline, shared out among its causes.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/models/oscillator.hpp"
#include "experiments/text/progress.hpp"
#include "fem/beam.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {

// From a beam that was pulled and released to K and C, with every cause of error switched on or off.

// What stands between a beam and the K and C that a pipeline reports.

/// One cause of error, off in the clean pipeline and on in the full one.
struct CauseText {
  const char* name;   ///< key of results
  const char* label;  ///< in a figure
  const char* on;     ///< what the full pipeline does
  const char* off;    ///< what the clean one does instead
};

/// In the order in which a measurement meets them, from the beam to the filter.
enum class Cause : std::size_t {
  amplitude_damping,
  higher_modes,
  sensor_mass,
  sensor_noise,
  sensor_bias,
  sampling,
  high_pass,
  integration,
  reduction,
  discretisation,
  initial_covariance,
  linearisation
};

inline constexpr std::size_t cause_count = 12;
using Causes = std::bitset<cause_count>;  ///< those that are on

inline constexpr std::array<CauseText, cause_count> causes{
    {{"amplitude_damping", "amplitude", "a small quadratic damping", "linear damping"},
     {"higher_modes", "modes", "all modes in the record", "the first mode alone"},
     {"sensor_mass", "mass", "a sensor whose mass was not counted", "a weightless sensor"},
     {"sensor_noise", "noise", "white noise of the sensor", "none"},
     {"sensor_bias", "bias", "a constant offset of the sensor", "none"},
     {"sampling", "sampling", "the stated rate", "twice that rate"},
     {"high_pass", "high-pass", "causal high-pass, its transient kept", "none, or its transient omitted"},
     {"integration", "integration", "displacement and velocity by integration", "acceleration observed"},
     {"reduction", "reduction", "Rayleigh's mass", "the first mode's own mass"},
     {"discretisation", "discretisation", "forward Euler", "the exact discretisation"},
     {"initial_covariance", "P0", "P0 = diag(1, 1, 1e5, 1e5)", "P0 as wide as the first guess errs"},
     {"linearisation", "one pass", "one pass over the record", "four passes"}}};

inline constexpr std::size_t index_of(Cause cause) {
  return static_cast<std::size_t>(cause);
}
inline Causes only(Cause cause) {
  return {1ULL << index_of(cause)};
}
inline Causes all_causes() {
  return Causes().set();
}

/// The full pipeline. What the 2009 study does not print is assumed, and said to be.
struct PipelineSettings {
  fem::Beam beam;
  int elements = 80;
  Eigen::VectorXd damping_ratios;   ///< of the modes (k), which are those in the record
  double deflection = 0.012;        ///< at the natural point, from which it is released [m]
  double duration = 25.0;           ///< [s]
  double sampling_rate = 1000.0;    ///< [Hz]
  double sensor_noise = 0.05;       ///< standard deviation [m/s2]
  double sensor_bias = 0.02;        ///< [m/s2]
  double sensor_mass = 0.002;       ///< not counted in the model [kg]
  double amplitude_damping = 0.02;  ///< growth of the first mode's damping at the release's amplitude
  double high_pass_hz = 0.5;        ///< second order
  std::uint64_t seed = 2009, stream = 0;
};

/// Relative errors, 100 (found / true - 1) [%]; contributions to them likewise.
struct ParameterErrors {
  double stiffness = 0.0, damping = 0.0;

  ParameterErrors operator+(const ParameterErrors& other) const {
    return {stiffness + other.stiffness, damping + other.damping};
  }
  ParameterErrors operator-(const ParameterErrors& other) const {
    return {stiffness - other.stiffness, damping - other.damping};
  }
  ParameterErrors operator/(double divisor) const { return {stiffness / divisor, damping / divisor}; }
};

/// One beam before noise and filter. The truth is its first mode at the natural point,
///
///     M = 1 / (H phi)^2,   K = M w^2,   C = 2 xi w M
///
/// at small amplitude and without the sensor.
class Pipeline {
 public:
  /// @throws std::invalid_argument when the settings are impossible
  explicit Pipeline(PipelineSettings settings);

  const PipelineSettings& settings() const { return settings_; }
  const Oscillator& truth() const { return truth_; }

  /// What the filter finds with these causes on. Not finite where the filter failed.
  ParameterErrors errors(const Causes& on) const;

  /// In closed form: the error of Rayleigh's mass, which is that of K and of C.
  ParameterErrors reduction() const;
  /// In closed form: forward Euler at this interval [s] (discretisation_bias.hpp).
  ParameterErrors discretisation(double interval) const;
  /// Cramer-Rao bound of noise at the clean pipeline's rate: standard deviations [%].
  ParameterErrors noise_bound() const;

 private:
  struct Shape {
    Eigen::VectorXd amplitudes, frequencies, ratios;  // of the modes at the point [m], [rad/s]
  };

  PipelineSettings settings_;
  Shape bare_, loaded_;  // without and with the sensor's mass
  Oscillator truth_;
  double rayleigh_mass_ = 0.0;

  Shape shape(const fem::StructuralSystem& system) const;
  /// What the sensor says, and the R of a filter that reads it: the sensor's and, for the higher modes that
  /// it takes for noise, their mean square times the samples in a period of the first.
  struct Acceleration {
    Eigen::VectorXd samples;
    double variance = 0.0;
  };
  Acceleration acceleration(const Causes& on, const Eigen::VectorXd& time) const;
};

/// One cause's part in the error, counted in four ways [% of K and of C].
struct Contribution {
  ParameterErrors alone;        ///< e({i}) - e({}): switched on in the clean pipeline
  ParameterErrors without;      ///< e(all) - e(all but i): what switching it off alone would take away
  ParameterErrors in_sequence;  ///< e({1..i}) - e({1..i-1}): from the beam to the filter; adds up
  ParameterErrors average;      ///< over several orders, each of which adds up: so does this
};

/// e is the error with a set of causes on.
struct Budget {
  std::string name;
  Pipeline pipeline;
  ParameterErrors clean, total;             ///< e({}), e(all)
  std::vector<Contribution> contributions;  ///< in the order of `causes`
  ParameterErrors interaction;              ///< total - clean - sum of `alone`
  int runs = 0;                             ///< filters that were run
};

/// The budget of one pipeline.
///
/// The average is Shapley's value [shapley1953] over all orders, here over `orders` of them: the pipeline's
/// own, its reverse, then random ones in pairs with their reverses, seeded as the noise is.
/// @throws std::invalid_argument when orders < 2
Budget make_budget(
    const std::string& name, const PipelineSettings& settings, int orders,
    const Progress& progress = [](const std::string&) {});

/// Index of the cause whose contribution is largest in absolute value.
std::size_t largest(const std::vector<Contribution>& contributions, ParameterErrors Contribution::*way,
                    double ParameterErrors::*parameter);

}  // namespace beamid::experiments
