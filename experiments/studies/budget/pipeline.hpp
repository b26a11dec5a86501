// From a beam that was pulled and released to K and C, with every cause of error switched on or off.
#pragma once

#include <cstdint>

#include "experiments/models/oscillator.hpp"
#include "experiments/studies/budget/cause.hpp"
#include "fem/beam.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
