// How the curves of a panel are drawn, in gnuplot's language.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// How many columns of NAME.csv a curve takes: x, then y unless it is a band, then lower and upper where it
/// has them.
int column_count(const Curve& curve);

/// Whether `lower` and `upper` are bounds of x.
bool along_x(const Curve& curve);

/// The names of the colours that the curves of the panels have. One label has one colour throughout.
std::vector<std::vector<std::string>> colours_of(const Figure& figure);

/// The plot command of a panel.
/// @param column the first column of the panel's curves, from 1; moved on to the next panel's.
/// @param names of its curves' colours, from colours_of()
std::string plot_command(const Panel& panel, const std::vector<std::string>& names, int& column);

}  // namespace beamid::experiments
