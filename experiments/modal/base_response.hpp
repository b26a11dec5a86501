// The first mode of what stands, or lies, on a base whose motion was measured: a soil column under an
// earthquake.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>

namespace beamid::experiments {

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

}  // namespace beamid::experiments
