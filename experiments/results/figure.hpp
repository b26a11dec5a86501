// A figure: its data, a gnuplot script to restyle, and the pictures drawn by it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace beamid::experiments {

// A long curve thinned so that its picture stays the same.

/// Most points of a line in the data of a figure, and so in its picture.
inline constexpr Eigen::Index most_drawn_points = 4000;

/// Most points of a line that are kept in memory, for a page to zoom into. A multiple of what pictures show:
/// their intervals are made of whole ones of these, and so their lowest and highest points are the same.
inline constexpr Eigen::Index most_kept_points = 50 * most_drawn_points;

/// Indices of the points to keep, ascending, at most about `limit`: the first and the last, and the lowest
/// and the highest of every interval, the intervals being equally wide on the axis. Points that are not
/// finite leave a gap and keep it.
///
/// @param x (N) abscissae. Where they do not ascend, the intervals hold equally many points instead.
/// @param y (N) ordinates.
/// @param logarithmic whether x is drawn on a logarithmic axis.
std::vector<Eigen::Index> envelope(const Eigen::VectorXd& x, const Eigen::VectorXd& y, bool logarithmic,
                                   Eigen::Index limit = most_drawn_points);

/// How a curve is drawn. A band is a shaded area between `lower` and `upper`; points with `lower` and `upper`
/// carry error bars; intervals are points with bars along x from `lower` to `upper`; arrows point along x
/// from `lower` to `upper`; stems stand on zero.
enum class CurveStyle { line, dashed, dotted, thin, points, open_points, stems, intervals, arrows, band };

/// Told apart by colour-blind readers too [okabe2008]. `automatic` takes the first six in turn, a band the
/// colour of the curve after it; a label that an earlier panel of the figure has keeps its colour.
enum class Colour { automatic, blue, vermillion, green, purple, orange, sky, black, grey };

/// What a page shows of a point that is clicked, in text.
struct PointDetail {
  std::string title;                           ///< "set 2"
  std::vector<std::vector<std::string>> rows;  ///< of one table; the first is its head
  std::string note = {};                       ///< below the table
  std::string command = {};                    ///< repeats what the point stands for
  std::string mode = {};                       ///< name of a mode of the section's model, which then swings
};

/// One number of each point, for a click.
struct PointFact {
  std::string label;  ///< "damping ratio [%]"
  Eigen::VectorXd values;
};

/// Labels and titles are UTF-8 and taken literally but for "^{...}" and "_{...}", which raise and lower.
struct Curve {
  std::string label;  ///< in the legend; empty: not there
  Eigen::VectorXd x;  ///< (N)
  Eigen::VectorXd y;  ///< (N); NaN leaves a gap; not used by a band
  CurveStyle style = CurveStyle::line;
  Eigen::VectorXd lower = {}, upper = {};  ///< (N) of a band or of error bars, else empty
  Colour colour = Colour::automatic;
  Eigen::Index points = 0;  ///< in the frame before it was thinned; 0: it was not
  // A click on a point, in a page: numbers and a mode shape, or text.
  std::vector<PointFact> facts = {};
  Eigen::MatrixXcd shapes = {};           ///< (channels of the panel x N), each of any scale; or empty
  std::vector<PointDetail> details = {};  ///< (N), or one of the whole curve; empty: none
};

/// Whether a curve is drawn through its points, or between them, so that its envelope may stand for it.
bool is_line(const Curve& curve);

/// One axis of a panel.
struct Axis {
  std::string label;  ///< with its unit: "time [s]"
  bool logarithmic = false;
  std::optional<std::pair<double, double>> range = {};  ///< absent: from the curves
  double tick = 0;                      ///< from tick to tick; 0: as many as there is room for
  std::vector<std::string> names = {};  ///< of the places 1, 2, ..., instead of numbers; upright from the top
};

/// Only `below` never hides a curve; inside the frame the legend has an opaque ground. A legend that all
/// panels have in common is drawn once, below the last row.
enum class Legend { below, top_right, top_left, bottom_right, bottom_left, none };

/// Built by adding curves:
///
///     Panel{"", {"time [s]"}, {"frequency [Hz]"}}
///         .band("95 %", t, f - w, f + w).line("filter", t, f, Colour::blue).level("modal analysis", 3.4555);
struct Panel {
  std::string title;  ///< may be empty
  Axis x_axis, y_axis;
  std::vector<Curve> curves = {};
  Legend legend = Legend::below;
  std::vector<std::string> remarks = {};  ///< right of the frame, beside the places 1, 2, ... of the y axis
  /// Of mode shapes behind points: names of the channels, and where they stand on a line, 0 to 1; without
  /// places, as of channels of different quantities, a shape is drawn as bars.
  std::vector<std::string> channels = {};
  Eigen::VectorXd places = {};

  using Values = Eigen::VectorXd;
  Panel& add(CurveStyle style, std::string label, Values x, Values y, Colour colour = Colour::automatic);
  Panel& line(std::string label, Values x, Values y, Colour colour = Colour::automatic);
  Panel& thin(std::string label, Values x, Values y, Colour colour = Colour::automatic);
  Panel& dashed(std::string label, Values x, Values y, Colour colour = Colour::automatic);
  Panel& points(std::string label, Values x, Values y, Colour colour = Colour::automatic);
  Panel& open_points(std::string label, Values x, Values y, Colour colour = Colour::automatic);
  Panel& band(std::string label, Values x, Values lower, Values upper, Colour colour = Colour::automatic);
  /// Points with error bars from `lower` to `upper`.
  Panel& bars(std::string label, Values x, Values y, Values lower, Values upper,
              Colour colour = Colour::automatic);
  /// A dashed line at one height, as wide as the axis or, without a range of it, the curves added so far.
  Panel& level(std::string label, double height, Colour colour = Colour::black);
  /// A dashed line at one place, as high as the axis or the curves added so far.
  Panel& upright(std::string label, double place, Colour colour = Colour::black);
  Panel& across(double from, double to);  ///< range of the x axis
  Panel& up(double from, double to);      ///< range of the y axis
  Panel& key(Legend place);               ///< where the legend stands
};

/// Panels side by side: one picture.
struct Figure {
  std::string name;           ///< of its files, without ending: letters, digits, '_', '-', '.'
  std::vector<Panel> panels;  ///< row by row
  int rows = 1, columns = 1;
  int width = 800;           ///< [px] of the SVG; the PNG is twice as large
  int height = 0;            ///< [px]; 0: from the rows and columns
  std::string caption = {};  ///< below it on a page; empty: titles or axes of its panels
};

/// Writes NAME.csv, NAME.gp, NAME.svg and NAME.png; the same figure gives the same bytes.
///
/// NAME.csv holds the curves side by side, thinned to about 4000 points each (figure.hpp), shorter ones
/// padded with empty fields; `gnuplot NAME.gp` in the same folder draws the pictures again.
/// @throws std::invalid_argument when the figure is impossible: sizes of x and y, its name, no place for a
/// panel.
/// @throws std::runtime_error when a file cannot be written, or gnuplot is missing or fails, with its
/// message.
void write(const Figure& figure, const std::filesystem::path& folder);

/// What the files of a figure show of its curves, in a sentence, where they show an envelope; empty where
/// they show every point.
std::string thinning_text(const Figure& figure);
/// The panel with the points that a page can zoom into, 200 000 a curve: a million samples take 16 MB a curve
/// before and 3 MB after. Files and pictures are the same. The range of the x axis is set before;
/// where the y axis has none and the visible part of a curve has not the extent of the whole, the panel stays
/// as it is.
Panel thinned(Panel panel);

/// Names of the files write() makes: "NAME.csv", "NAME.gp", "NAME.svg", "NAME.png".
std::vector<std::string> files_of(const Figure& figure);

// Panels that several commands draw of a signal.

/// A signal as it is drawn.
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
