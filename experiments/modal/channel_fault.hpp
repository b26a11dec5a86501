// Whether channels were recorded as described: of a base and what stands on it their order, a sign, a common
// clock; of a free decay a common clock.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/joint_decay_fit.hpp"

namespace beamid::experiments {

/// The first mode of what stands, or lies, on a base whose motion was measured: a soil column under an
/// earthquake.
struct BaseResponse {
  double frequency_hz = 0.0, frequency_deviation_hz = 0.0;  ///< f1, of the fit [Hz]
  double damping_ratio = 0.0, damping_ratio_deviation = 0.0;
  double participation = 0.0;           ///< Gamma of the mode at the sensor
  double left_percent = 0.0;            ///< of the relative motion in the band, what the fit leaves
  std::pair<double, double> band_hz{};  ///< that was fitted
};

/// f1 and xi of the absolute acceleration y over that of the base u, in the frequency domain: with the DFTs Y
/// and U of both, their ends tapered,
///
///     Y - U = U f^2 (Gamma / (f1^2 - f^2 + 2 i xi f1 f) + rho / f1^2)
///
/// by least squares over a band, rho being what higher modes add below their resonances. Deviations are those
/// by what the fit leaves.
/// @param band_hz where to look, and what is fitted; absent: about the lowest peak of |Y| / |U| that is half
/// as high as the highest, from half its frequency to one and a half times
/// @throws std::invalid_argument where there is no such peak, the band holds fewer than 16 lines, or the fit
/// leaves more than half of the motion: no mode.
BaseResponse base_response(const Eigen::VectorXd& base, const Eigen::VectorXd& response, double interval,
                           const std::optional<std::pair<double, double>>& band_hz);

/// What of the two channels, changed, explains their motion much better.
struct ChannelFault {
  enum class Kind {
    none,
    reversed,  ///< the response with its sign turned
    late,      ///< the response some samples earlier; negative: later
    exchanged  ///< the base for the response
  };
  Kind kind = Kind::none;
  int samples = 0;            ///< by which the response is late
  BaseResponse instead;       ///< what is found then
  double left_percent = 0.0;  ///< of the channels as they are; infinite where they show no mode
  bool surely() const { return kind != Kind::none; }
};

inline constexpr int most_late_samples = 10;

/// Fits the lowest mode, whatever band is asked about, to the channels as they are and changed: about a
/// higher one those below it are not in the model. A change counts where the fit leaves less than 0.7 of what
/// it left (half of its square), or, of a participation below zero, less with the sign turned. The order is
/// doubted only where the response moves less than the base, or xi is above 0.3. Where the channels show no
/// mode, every change that gives one counts.
ChannelFault channel_fault(const Eigen::VectorXd& base, const Eigen::VectorXd& response, double interval);

// Whether all channels of a free decay ring at the same frequencies.

/// A structure has one frequency for each mode, wherever it is measured: channels whose own frequencies, one
/// Gauss-Newton step from the joint ones, scatter by more than their deviations have clocks of their own.
struct ClockScatter {
  double chi_square = 0.0, freedom = 0.0;  ///< of the channels' frequencies about those of their modes
  Eigen::VectorXd farthest;  ///< of each mode, how far the farthest of its channels surely is (K) [rad/s]
  Eigen::Index fast = 0, slow = 0;      ///< the clocks furthest apart, of the channels (p)
  double apart = 0.0, deviation = 0.0;  ///< by how much, relative

  /// "The channels do not ring at one frequency ...: tip runs 100 ppm faster than mid, ...".
  std::string sentence(const std::vector<std::string>& channels) const;
};

/// Absent where they agree: chi^2 below its 1e-6 point, as the noise near each mode is itself estimated from
/// few lines.
std::optional<ClockScatter> clock_scatter(const JointDecayFit& fit);

}  // namespace beamid::experiments
