// The paper's own test of its filter: a simulated oscillator, noise-free (its table 2, its figures 2 and 3).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/models/identification.hpp"

namespace beamid::experiments::paper {

/// M = 3.0 kg, K = 515.8 N/m, damping ratio 10 %, sampled every millisecond [inverse2009].
inline constexpr double validation_interval = 1e-3;  // [s]
Oscillator validation_truth();

inline constexpr double published_stiffness_error_percent = 0.13;  // as printed, without sign
inline constexpr double published_damping_error_percent = 6.41;

/// The schemes compared, the paper's first.
const std::vector<std::string>& compared_schemes();

/// A simulated free decay and the filter that reads it.
struct ValidationSettings {
  std::vector<Quantity> observed{Quantity::displacement, Quantity::velocity};
  double release = 1.0;  ///< initial displacement [m]; the paper does not print it
  double duration = 5.0;
  double noise_variance = 1e-5;                      ///< R, as the paper
  double velocity_variance = 0.0;                    ///< R of velocity where it differs; 0: as of the other
  double process_variance = 0.0;                     ///< Q of displacement and velocity, per step
  Eigen::Vector4d initial_variance{1, 1, 1e5, 1e5};  ///< P0: the paper prints 10^-5 for K and C
  double first_stiffness = 300.0, first_damping = 2.0;
  int passes = 1;
  Oscillator truth = validation_truth();
  double interval = validation_interval;  ///< [s]
  std::string data = "exact";             ///< what makes the record (data_generator.hpp)
  /// Standard deviations of the noise on displacement [m] and on velocity [m/s], and its seed.
  Eigen::Vector2d sensor_noise = Eigen::Vector2d::Zero();
  std::uint64_t seed = 2009;
};

/// The filter's K and C, and its history when kept. The first sample used is one interval after the release.
Identification validate(const std::string& filter, const std::string& scheme,
                        const ValidationSettings& settings,
                        filters::Keep keep = filters::Keep::last_estimate);

/// Settings under which neither prior nor linearisation leaves a trace: displacement alone, R = 1e-12, two
/// passes.
ValidationSettings bias_settings();

}  // namespace beamid::experiments::paper
