// Whether the modes of a free decay keep their phases along the record.
#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/modal/joint_decay_fit.hpp"

namespace beamid::experiments {

/// What a walk of the phases adds to the standard deviations of a mode.
struct WalkDeviation {
  double frequency_hz = 0, damping_ratio = 0;

  /// Standard deviations without a walk become those with it.
  void widen(double& of_frequency_hz, double& of_damping_ratio) const;
};

/// A random walk of the phases of all modes, as a clock whose intervals scatter makes it.
struct PhaseWalk {
  double clock = 0;                    ///< what its variance grows by in a second [s^2/s]
  double squares = 0, freedom = 0;     ///< chi^2 of the phases about smooth functions of time
  double over_levels = 0;              ///< over that of the amplitudes' logarithms; 0: not asked
  Eigen::Index sections = 0;           ///< of the record
  double duration = 0;                 ///< of the record [s]
  std::vector<std::size_t> sidebands;  ///< modes of the fit that are sidebands of a stronger one

  WalkDeviation deviation(std::complex<double> rate) const;
  /// Beyond the 99.99 % point: worth a warning.
  bool is_sure() const;
  std::string sentence() const;
};

/// What phases are larger than where they wander.
enum class WalkAgainst { noise, amplitudes };

/// Even stamps of a clock whose intervals scatter, and frequencies that change, let phases wander about those
/// of the fit. In sections of the record, the fitted rates held, each mode's own amplitude is A_s e^(i phi_s)
/// of the joint one's. Where the phi_s, a line through them taken out, are larger than noise makes them
/// (chi^2 over modes and sections beyond its 99 % point), a random walk of them,
///
///     E (phi_t - phi_s)^2 = q |t - s|,
///
/// adds q max(sigma / 2, 1.2 / T) to the variance of the angular frequency of a mode of damping rate sigma in
/// a record of length T (weighted by e^(-2 sigma t), or not at all), and (q / 4)^2 to that of its rate. A
/// clock's walk is in time: q / omega^2, from all modes together. Weak modes beside a strong one, of its
/// shape in several channels, are left out: they would be its sidebands.
///
/// Noise is alike in phases and in the logarithms of amplitudes, as are beats of a mode that was not fitted;
/// a clock is in the phases alone. Against amplitudes, phases about 1, t, t^2, A and A^2 of the amplitude A
/// are larger than those of amplitudes are (F beyond its 99.9 % point): for records whose noise near the mode
/// may be the walk's own sidebands, and frequencies that follow the amplitude.
/// @param record (p x N)
/// @return nothing where the phases keep to their lines, or the record is too short for four sections; six
/// against amplitudes
std::optional<PhaseWalk> phase_walk(const JointDecayFit& fit, const Eigen::MatrixXd& record, double interval,
                                    WalkAgainst against = WalkAgainst::noise);

/// A mode without companions within a tenth of its frequency, which sidebands of a walk may be.
ModalEstimate without_neighbours(ModalEstimate mode);

}  // namespace beamid::experiments
