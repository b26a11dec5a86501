// Which poles of a hammer test's frequency responses are modes, and their least squares.
#pragma once

#include "experiments/modal/study/hammer_study.hpp"

namespace beamid::experiments {

/// Sets the modes: poles that are stable over the orders, and the large peaks that none of them stands for.
/// @param lines (F) of the band [Hz]; @param measured (p x F)
void choose_modes(const StabilisationSettings& settings, const Eigen::VectorXd& lines,
                  const Eigen::MatrixXcd& measured, HammerStudy& study);

/// Sets the fit, with all poles refined together or as they are. A pole that the fit carries off by more than
/// 5 % is left out; where none is left, the modes are those at the large peaks. What happened is told by the
/// study's warnings.
void fit_modes(const Eigen::VectorXd& lines, const Eigen::MatrixXcd& measured, bool refined,
               HammerStudy& study);

}  // namespace beamid::experiments
