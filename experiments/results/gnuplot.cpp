#include "experiments/results/gnuplot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

constexpr std::array colour_names{"",       "blue", "vermillion", "green", "purple",
                                  "orange", "sky",  "black",      "grey"};
// Circle, square, triangle, diamond and triangle down, filled and open.
constexpr std::array filled_marks{7, 5, 9, 13, 11};
constexpr std::array open_marks{6, 4, 8, 12, 10};

std::string curve_command(const Panel& panel, const Curve& curve, const std::string& colour, int first,
                          int mark) {
  const std::string title = curve.label.empty() ? "notitle" : "title " + gnuplot_text(curve.label);
  Extent drawn;
  drawn.add(curve.style == CurveStyle::band ? curve.upper : curve.y, panel.y_axis.logarithmic);
  if (curve.style == CurveStyle::arrows) drawn.add(curve.upper, false);
  if (drawn.empty())
    return fmt::format("NaN with lines linecolor rgb {} title {}", colour,
                       gnuplot_text(curve.label + " (no values)"));
  const int x = first, y = first + 1;
  const bool bars = curve.lower.size() > 0;
  // A bound at or below zero lies infinitely far down a logarithmic axis.
  const auto lower = [&](int place) {
    return panel.y_axis.logarithmic ? fmt::format("(${0} > 0 ? ${0} : 1e-300)", place)
                                    : std::to_string(place);
  };
  const auto line = [&](double width, const char* dashes) {
    return fmt::format("data skip 1 using {}:{} with lines linecolor rgb {} linewidth {}{} {}", x, y, colour,
                       width, dashes, title);
  };
  const auto points = [&](int type, double size, double width) {
    return fmt::format(
        "data skip 1 using {}:{}{} with {} linecolor rgb {} linewidth {} pointtype {} pointsize {} {}", x, y,
        bars ? fmt::format(":{}:{}", lower(y + 1), y + 2) : "", bars ? "yerrorbars" : "points", colour, width,
        type, size, title);
  };
  switch (curve.style) {
    case CurveStyle::line:
      return line(1.6, "");
    case CurveStyle::dashed:
      return line(1.6, " dashtype (9,5)");
    case CurveStyle::dotted:
      return line(1.6, " dashtype (2,4)");
    case CurveStyle::thin:
      return line(0.5, "");
    case CurveStyle::points:
      return points(filled_marks[mark % 5], 0.7, 1.0);
    case CurveStyle::open_points:
      return points(open_marks[mark % 5], 1.1, 1.6);
    case CurveStyle::stems:  // the first plot draws the stems, the second their heads
      return fmt::format(
          "data skip 1 using {0}:{1} with impulses linecolor rgb {2} linewidth 1.6 notitle, \\\n       "
          "data skip 1 using {0}:{1} with points linecolor rgb {2} pointtype 7 pointsize 0.6 {3}",
          x, y, colour, title);
    case CurveStyle::intervals:
      return fmt::format(
          "data skip 1 using {}:{}:{}:{} with xerrorbars linecolor rgb {} linewidth 1.4 pointtype {} "
          "pointsize 0.8 {}",
          x, y, y + 1, y + 2, colour, filled_marks[mark % 5], title);
    case CurveStyle::arrows:
      return fmt::format(
          "data skip 1 using {0}:{1}:(${2}-${0}):(0) with vectors head filled size screen 0.012,25 linecolor "
          "rgb {3} linewidth 1.6 {4}",
          y + 1, y, y + 2, colour, title);
    case CurveStyle::band:
      break;
  }
  return fmt::format(
      "data skip 1 using {}:{}:{} with filledcurves linecolor rgb {} fillstyle transparent solid 0.22 "
      "noborder {}",
      x, lower(y), y + 1, colour, title);
}

}  // namespace

bool along_x(const Curve& curve) {
  return curve.style == CurveStyle::intervals || curve.style == CurveStyle::arrows;
}

std::vector<std::vector<std::string>> colours_of(const Figure& figure) {
  std::vector<std::vector<std::string>> all;
  std::map<std::string, std::string> known;  // label -> colour
  for (const Panel& panel : figure.panels) {
    std::vector<std::string> names(panel.curves.size());
    std::size_t next = 0;
    for (std::size_t i = panel.curves.size(); i-- > 0;) {  // from behind: a band has the colour of its curve
      const Curve& curve = panel.curves[i];
      if (curve.colour != Colour::automatic) names[i] = colour_names[static_cast<std::size_t>(curve.colour)];
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Curve& curve = panel.curves[i];
      const bool band = curve.style == CurveStyle::band && i + 1 < names.size();
      if (!names[i].empty() || band) continue;
      const auto at = known.find(curve.label);
      names[i] = !curve.label.empty() && at != known.end() ? at->second : colour_names[1 + next % 6];
      ++next;
    }
    for (std::size_t i = names.size(); i-- > 0;)
      if (names[i].empty()) names[i] = names[i + 1];
    for (std::size_t i = 0; i < names.size(); ++i) known.emplace(panel.curves[i].label, names[i]);
    all.push_back(std::move(names));
  }
  return all;
}

int column_count(const Curve& curve) {
  return 1 + (curve.style == CurveStyle::band ? 0 : 1) + (curve.lower.size() > 0 ? 2 : 0);
}

std::string plot_command(const Panel& panel, const std::vector<std::string>& names, int& column) {
  std::string out = "  plot";
  if (panel.curves.empty()) out += " NaN notitle";
  int filled = 0, open = 0;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const int mark = curve.style == CurveStyle::points || curve.style == CurveStyle::intervals ? filled++
                     : curve.style == CurveStyle::open_points                                  ? open++
                                                                                               : 0;
    out += (i == 0 ? " " : ", \\\n       ") + curve_command(panel, curve, names[i], column, mark);
    column += column_count(curve);
  }
  return out + '\n';
}

namespace {

// [px] at the 13 px of the SVG's font.
constexpr double title_room = 40, no_title = 14, tick_room = 24, label_room = 24, key_row = 20, key_gap = 8;
constexpr double sample = 90, letter = 7.8;  // of an entry of a legend
constexpr double edge = 22;                  // right of a frame: half a tick's label

std::vector<std::string> legend_labels(const Panel& panel) {
  std::vector<std::string> labels;
  if (panel.legend == Legend::below)
    for (const Curve& curve : panel.curves)
      if (!curve.label.empty()) labels.push_back(curve.label);
  return labels;
}

int legend_columns(const std::vector<std::string>& labels, double width) {
  if (labels.empty()) return 0;
  std::size_t longest = 0;
  for (const std::string& label : labels) longest = std::max(longest, width_of(label));
  const int count = static_cast<int>(labels.size());
  const int fit =
      std::clamp(static_cast<int>(width / (sample + letter * static_cast<double>(longest))), 1, count);
  const int rows = (count + fit - 1) / fit;
  return (count + rows - 1) / rows;
}

double legend_height(const std::vector<std::string>& labels, int columns) {
  if (columns == 0) return 0;
  const int rows = (static_cast<int>(labels.size()) + columns - 1) / columns;
  return key_gap + key_row * rows;
}

/// The panel whose legend says all that the others' say: it is then said once, below the last row. -1: there
/// is none.
int common_legend(const Figure& figure) {
  std::vector<std::vector<std::string>> all;
  for (const Panel& panel : figure.panels) all.push_back(legend_labels(panel));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto holds = [&](const std::string& label) {
      return std::find(all[i].begin(), all[i].end(), label) != all[i].end();
    };
    if (!all[i].empty() && std::all_of(all.begin(), all.end(), [&](const auto& labels) {
          return std::all_of(labels.begin(), labels.end(), holds);
        }))
      return static_cast<int>(i);
  }
  return -1;
}

double remark_room(const Panel& panel) {
  return panel.remarks.empty() ? edge : 20 + named_ticks("y2", panel.remarks).widest;
}

double below_frame(const Panel& panel) {
  return tick_room + (panel.x_axis.label.empty() ? 0 : label_room);
}

}  // namespace

int picture_height(const Figure& figure) {
  return figure.height > 0 ? figure.height : figure.rows == 1 ? 460 : 330 * figure.rows;
}

std::vector<PanelPlace> panel_places(const Figure& figure, int height) {
  const auto count = static_cast<int>(figure.panels.size());
  const double cell = static_cast<double>(figure.width) / figure.columns;
  const int common = common_legend(figure);
  struct Row {
    double above = no_title, below = 0, key = 0;
  };
  std::vector<Row> rows(static_cast<std::size_t>((count + figure.columns - 1) / figure.columns));
  const auto row_of = [&](int i) -> Row& { return rows[static_cast<std::size_t>(i / figure.columns)]; };
  std::vector<PanelPlace> places(figure.panels.size());
  for (int i = 0; i < count; ++i) {
    const Panel& panel = figure.panels[static_cast<std::size_t>(i)];
    Row& row = row_of(i);
    if (!panel.title.empty()) row.above = title_room;
    row.below = std::max(row.below, below_frame(panel));
    if (common >= 0 && i != common) continue;
    const auto labels = legend_labels(panel);
    const int columns = legend_columns(labels, cell - 130);  // gnuplot makes it no wider than the frame
    places[static_cast<std::size_t>(i)].legend_columns = columns;
    double& key = (common >= 0 ? rows.back() : row).key;
    key = std::max(key, legend_height(labels, columns));
  }
  double taken = 0;
  for (const Row& row : rows) taken += row.above + row.below + row.key;
  constexpr double least_height = 40, last_margin = 4;
  const double frame =
      std::max(least_height, (height - taken - last_margin) / static_cast<double>(rows.size()));

  double top = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (int c = 0; c < figure.columns; ++c) {
      const std::size_t i = r * static_cast<std::size_t>(figure.columns) + static_cast<std::size_t>(c);
      if (i >= places.size()) break;
      places[i].top = top + rows[r].above;
      places[i].bottom = places[i].top + frame;
      places[i].legend_y = places[i].bottom + rows[r].below + key_gap;
    }
    top += rows[r].above + frame + rows[r].below + rows[r].key;
  }
  for (int c = 0; c < figure.columns; ++c) {
    double left = 0, right = edge;
    for (int i = c; i < count; i += figure.columns) {
      const Panel& panel = figure.panels[static_cast<std::size_t>(i)];
      left = std::max(left, drawn_y_axis(panel, frame).widest + (panel.y_axis.label.empty() ? 28 : 46));
      right = std::max(right, remark_room(panel));
    }
    for (int i = c; i < count; i += figure.columns) {
      PanelPlace& place = places[static_cast<std::size_t>(i)];
      place.left = c * cell + left;
      place.right = (c + 1) * cell - right;
      place.legend_x = common >= 0 ? 0.5 * figure.width : 0.5 * (place.left + place.right);
    }
  }
  if (common >= 0) places[static_cast<std::size_t>(common)].legend_y = top - rows.back().key + key_gap;
  return places;
}

namespace {

// Where the frame is, as parts of the picture from its lower left corner: both terminals have the same
// layout.
std::string frame_commands(const PanelPlace& place, const Figure& figure, int height) {
  return fmt::format(
      "  set lmargin at screen {:.5f}; set rmargin at screen {:.5f}; set tmargin at screen {:.5f}; set "
      "bmargin at "
      "screen {:.5f}\n",
      place.left / figure.width, place.right / figure.width, 1 - place.top / height,
      1 - place.bottom / height);
}

std::string legend_commands(const PanelPlace& place, const Panel& panel, const Figure& figure, int height) {
  const auto inside = [](const char* corner) {
    return fmt::format("  set key inside {} vertical maxcols 1 opaque fillcolor rgb '#ffffff'\n", corner);
  };
  switch (panel.legend) {
    case Legend::top_right:
      return inside("top right");
    case Legend::top_left:
      return inside("top left");
    case Legend::bottom_right:
      return inside("bottom right");
    case Legend::bottom_left:
      return inside("bottom left");
    case Legend::below:
    case Legend::none:
      break;
  }
  if (place.legend_columns == 0) return "  unset key\n";
  return fmt::format("  set key at screen {:.5f}, screen {:.5f} center top horizontal maxcols {} noopaque\n",
                     place.legend_x / figure.width, 1 - place.legend_y / height, place.legend_columns);
}

// Texts right of the frame, as the ticks of an axis of its own.
std::string remark_commands(const Panel& panel) {
  if (panel.remarks.empty()) return "  unset y2tics\n";
  const double last = static_cast<double>(panel.remarks.size()) + 0.6;
  return fmt::format("  set y2range [{}:0.4]; set y2tics scale 0\n", last) +
         named_ticks("y2", panel.remarks).commands;
}

std::string panels_commands(const Figure& figure, int height) {
  std::string out;
  int column = 1;
  const auto colours = colours_of(figure);
  const std::vector<PanelPlace> places = panel_places(figure, height);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const Panel& panel = figure.panels[i];
    const PanelPlace& place = places[i];
    out += fmt::format("\n  set title {}\n", gnuplot_text(typeset(panel.title))) +
           frame_commands(place, figure, height) + drawn_x_axis(panel, place.right - place.left).commands +
           drawn_y_axis(panel, place.bottom - place.top).commands + remark_commands(panel) +
           legend_commands(place, panel, figure, height) + plot_command(panel, colours[i], column);
  }
  return out;
}

constexpr const char* opening = R"(# Figure {name}, drawn from {name}.csv, whose first line names the columns.
# Change what you like here and run, in this folder:  gnuplot {name}.gp
# It writes {name}.svg and {name}.png.
reset
set encoding utf8
set datafile separator comma
data = '{name}.csv'

# Colours that colour-blind readers distinguish (Okabe and Ito).
blue = '#0072b2'; vermillion = '#d55e00'; green = '#009e73'; purple = '#cc79a7'; orange = '#e69f00'
sky = '#56b4e9'; black = '#000000'; grey = '#7f7f7f'

# Frame, ticks, grid and legend of every panel.
set border 3 linewidth 0.8 linecolor rgb '#404040'
set tics out nomirror scale 0.7,0.4
set grid back linetype 1 linewidth 0.5 linecolor rgb '#dcdcdc'
set key Left reverse samplen 2.4

# Each picture in turn: text stays text in the SVG; the PNG has twice as many pixels.
# Rows of legends have equal heights in both.
do for [picture in 'svg png'] {{
  if (picture eq 'svg') {{
    set terminal svg size {width},{height} enhanced font 'DejaVu Sans,13' background '#ffffff'
    set title font ',14' offset 0,-0.4; set xlabel offset 0,0.75
    set xtics offset 0,0.35; set key spacing 1
  }} else {{
    set terminal pngcairo size {width2},{height2} enhanced font 'DejaVu Sans,10' fontscale 2 \
        linewidth 2 pointscale 2 dashlength 1.6
    set title font ',11'; set xlabel offset 0,0.3; set xtics offset 0,0; set key spacing 1.15
  }}
  set output '{name}.'.picture
  set multiplot
)";

}  // namespace

std::string gnuplot_text(const std::string& label) {
  const std::string text = clean_text(label);
  std::string out = "\"";
  std::ptrdiff_t depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto closing = [&] { return std::count(text.begin() + static_cast<long>(i), text.end(), '}'); };
    if (std::string_view(text).substr(i, 3) == "\\U+")
      continue;  // gnuplot knows no way to write it literally
    if ((c == '^' || c == '_') && i + 1 < text.size() && text[i + 1] == '{' && closing() > depth) {
      out += c;
      out += '{';
      ++i, ++depth;
    } else if (c == '}' && depth > 0) {
      out += c;
      --depth;
    } else {
      // A backslash for "enhanced text", written as two, and the character by its octal code where the
      // script's own language would take it for a command or the string's end.
      if (std::string("^_@&~{}\\").find(c) != std::string::npos) out += "\\\\";
      out += std::string("\"`@\\").find(c) != std::string::npos ? fmt::format("\\{:03o}", int{c})
                                                                : std::string(1, c);
    }
  }
  return out + '"';
}

std::string gnuplot_script(const Figure& figure) {
  const int height = picture_height(figure);
  std::string script = fmt::format(fmt::runtime(opening), fmt::arg("name", figure.name),
                                   fmt::arg("width", figure.width), fmt::arg("height", height),
                                   fmt::arg("width2", 2 * figure.width), fmt::arg("height2", 2 * height));
  return script + panels_commands(figure, height) + "\n  unset multiplot\n  unset output\n}\n";
}

}  // namespace beamid::experiments
