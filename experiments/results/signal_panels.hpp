// Panels that several commands draw of a signal.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

struct DrawnSignal {
  std::string label;  ///< in the legend; empty where there is one signal
  Eigen::VectorXd samples;
  Colour colour = Colour::black;
};

/// Amplitude spectra (signal/amplitude_spectrum.hpp) over frequency, from the first line above 0 on. The axis
/// ends `decades` below the highest peak; the curves go on below it, so that the data beside the figure are
/// the true ones. Missing samples are drawn straight across.
/// @param label of the vertical axis, "acceleration [m/s2]"
/// @return nothing where no signal moves.
std::optional<Panel> spectrum_panel(const std::vector<DrawnSignal>& signals, double interval,
                                    const std::string& label, double decades = 6);

/// The record, thin and black, in front of what reproduces it.
Panel reproduction_panel(const std::string& title, const Eigen::VectorXd& time,
                         const Eigen::VectorXd& measured, const std::vector<DrawnSignal>& reproduced,
                         const std::string& label);

/// Measured minus reproduced, up to the round number above it.
/// @param label of the record's axis; "residual, " comes before it
/// @param largest of panels on one scale, in place of the residual's own; 0: its own
Panel residual_panel(const std::string& title, const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                     const std::string& label, double largest = 0.0);

}  // namespace beamid::experiments
