// Modes at the peaks of frequency responses, each from the lines around it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/modal/pole.hpp"

namespace beamid::experiments {

/// One pole at each peak of sum_o |H_o / s^(k-1)|^2, the mobility, that rises to 1.2 times the valley between
/// it and any larger one. Over the lines above half of the peak's power, five at least,
///
///     H_o / s^k = B_o + R_o / (s - p)    <=>    s H_o / s^k = p H_o / s^k + B_o s + (R_o - B_o p),
///
/// linear in p, B_o and the rest: least squares, exact where nothing else varies over them. Where the width
/// alone would take all of H for the mode's, B_o stands for its neighbours; and lines need not be so dense
/// that a half-power point is met. [ewins2000, ch. 4]
///
/// Noise has peaks as well: one whose lines, five at least, are left by the fit to more than a tenth of the
/// mode's own part is none.
/// @param frequency_hz (F), rising; @param responses (p x F) at s = i 2 pi f + shift
/// @param power k: 0, 1, 2 for displacement, velocity, acceleration per force
/// @param smallest peak, over the largest
std::vector<Pole> poles_at_peaks(const Eigen::VectorXd& frequency_hz, const Eigen::MatrixXcd& responses,
                                 double shift, int power, double smallest);

}  // namespace beamid::experiments
