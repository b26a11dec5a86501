// Where frames and legends stand in a picture.
#pragma once

#include <vector>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
