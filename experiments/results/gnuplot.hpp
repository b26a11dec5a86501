// From a figure to gnuplot's language.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

// How the curves of a panel are drawn, in gnuplot's language.

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

// Where frames and legends stand in a picture.

/// [px] of the SVG, from its upper left corner.
struct PanelPlace {
  double left = 0, right = 0, top = 0, bottom = 0;  ///< of the frame
  double legend_x = 0, legend_y = 0;                ///< middle and upper edge of the legend below it
  int legend_columns = 0;                           ///< 0: no legend below
};

int picture_height(const Figure& figure);

/// Frames of one height, those above each other with one left edge, and room below for ticks, label and
/// legend: a legend stands on nothing, in the SVG and in the PNG alike.
std::vector<PanelPlace> panel_places(const Figure& figure, int height);

/// A text as gnuplot shall read it: cleaned (fields.hpp), in double quotes, with octal codes for what
/// these would execute or expand ("`", "@"), and with all that "enhanced text" would interpret taken
/// literally, but for "^{...}" and "_{...}".
std::string gnuplot_text(const std::string& label);

/// The script that draws NAME.svg and NAME.png from NAME.csv.
std::string gnuplot_script(const Figure& figure);

}  // namespace beamid::experiments
