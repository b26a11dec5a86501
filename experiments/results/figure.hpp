// A figure: its data, a gnuplot script to restyle, and the pictures drawn by it.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace beamid::experiments {

/// How a curve is drawn. A band is a shaded area between `lower` and `upper`; points with `lower` and `upper`
/// carry error bars.
enum class CurveStyle { line, dashed, dotted, points, open_points, band };

/// Told apart by colour-blind readers too [okabe2008]. `automatic` takes the first six in turn, a band the
/// colour of the curve after it.
enum class Colour { automatic, blue, vermillion, green, purple, orange, sky, black, grey };

/// Labels and titles are UTF-8 and taken literally but for "^{...}" and "_{...}", which raise and lower.
struct Curve {
  std::string label;  ///< in the legend; empty: not there
  Eigen::VectorXd x;  ///< (N)
  Eigen::VectorXd y;  ///< (N); NaN leaves a gap; not used by a band
  CurveStyle style = CurveStyle::line;
  Eigen::VectorXd lower = {}, upper = {};  ///< (N) of a band or of error bars, else empty
  Colour colour = Colour::automatic;
};

struct Axis {
  std::string label;  ///< with its unit: "time [s]"
  bool logarithmic = false;
  std::optional<std::pair<double, double>> range = {};  ///< absent: from the curves
};

/// Only `below` never hides a curve; inside the frame the legend has an opaque ground.
enum class Legend { below, top_right, top_left, bottom_right, bottom_left, none };

struct Panel {
  std::string title;  ///< may be empty
  Axis x_axis, y_axis;
  std::vector<Curve> curves;
  Legend legend = Legend::below;
};

struct Figure {
  std::string name;           ///< of its files, without ending: letters, digits, '_', '-', '.'
  std::vector<Panel> panels;  ///< row by row
  int rows = 1, columns = 1;
  int width = 800;  ///< [px] of the SVG; the PNG is twice as large
  int height = 0;   ///< [px]; 0: from the rows and columns
};

/// Writes NAME.csv, NAME.gp, NAME.svg and NAME.png; the same figure gives the same bytes.
///
/// NAME.csv holds the curves side by side, thinned to about 4000 points each (envelope.hpp), shorter ones
/// padded with empty fields; `gnuplot NAME.gp` in the same folder draws the pictures again.
/// @throws std::invalid_argument when the figure is impossible: sizes of x and y, its name, no place for a
/// panel.
/// @throws std::runtime_error when a file cannot be written, or gnuplot is missing or fails, with its
/// message.
void write(const Figure& figure, const std::filesystem::path& folder);

/// Names of the files write() makes: "NAME.csv", "NAME.gp", "NAME.svg", "NAME.png".
std::vector<std::string> files_of(const Figure& figure);

}  // namespace beamid::experiments
