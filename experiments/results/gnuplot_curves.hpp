// How the curves of a panel are drawn, in gnuplot's language.
#pragma once

#include <string>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// How many columns of NAME.csv a curve takes: x, then y unless it is a band, then lower and upper where it
/// has them.
int column_count(const Curve& curve);

/// The plot command of a panel.
/// @param column the first column of the panel's curves, from 1; moved on to the next panel's.
std::string plot_command(const Panel& panel, int& column);

}  // namespace beamid::experiments
