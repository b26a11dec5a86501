#include "experiments/results/gnuplot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/gnuplot_curves.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/clean_text.hpp"

namespace beamid::experiments {
namespace {

// Place and shape of the legend. Those below the frames of one row of panels take equal room, so that the
// frames stay level.
struct LegendShape {
  int rows = 0, columns = 0;
};

LegendShape shape_below(const Panel& panel, int panel_width) {
  int labels = 0;
  std::size_t longest = 0;
  for (const Curve& curve : panel.curves) {
    if (curve.label.empty()) continue;
    ++labels;
    longest = std::max(longest, width_of(curve.label));
  }
  if (labels == 0 || panel.legend != Legend::below) return {};
  constexpr double frame_margin = 80, sample = 60, letter = 7.8;  // [px] at the 13 px of the SVG's font
  const int fit =
      static_cast<int>((panel_width - frame_margin) / (sample + letter * static_cast<double>(longest)));
  const int columns = std::clamp(fit, 1, labels), rows = (labels + columns - 1) / columns;
  return {rows, (labels + rows - 1) / rows};
}

std::string legend_commands(const Panel& panel, const LegendShape& shape, int rows_below) {
  const std::string margin =
      rows_below == 0 ? "unset bmargin" : fmt::format("set bmargin {:.2f}", 4.0 + 1.2 * rows_below);
  const auto inside = [&](const char* place) {
    return fmt::format("  {}; set key inside {} vertical maxcols 1 opaque fillcolor rgb '#ffffff'\n", margin,
                       place);
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
      if (shape.columns > 0)
        return fmt::format("  {}; set key bmargin center horizontal maxcols {} noopaque\n", margin,
                           shape.columns);
      break;
    case Legend::none:
      break;
  }
  return "  " + margin + "; unset key\n";
}

std::string panels_commands(const Figure& figure) {
  std::string out;
  int column = 1;
  const int across = figure.columns, width = figure.width / across,
            count = static_cast<int>(figure.panels.size());
  for (int first = 0; first < count; first += across) {
    const int last = std::min(first + across, count);
    int rows_below = 0;
    for (int i = first; i < last; ++i)
      rows_below = std::max(rows_below, shape_below(figure.panels[i], width).rows);
    for (int i = first; i < last; ++i) {
      const Panel& panel = figure.panels[i];
      out += fmt::format("\n  set title {}\n", gnuplot_text(panel.title)) + axis_commands(panel) +
             legend_commands(panel, shape_below(panel, width), rows_below) + plot_command(panel, column);
    }
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

# Colours that colour-blind readers tell apart (Okabe and Ito).
blue = '#0072b2'; vermillion = '#d55e00'; green = '#009e73'; purple = '#cc79a7'; orange = '#e69f00'
sky = '#56b4e9'; black = '#000000'; grey = '#7f7f7f'

# Frame, ticks, grid and legend of every panel.
set border 3 linewidth 0.8 linecolor rgb '#404040'
set tics out nomirror scale 0.7,0.4
set grid back linetype 1 linewidth 0.5 linecolor rgb '#dcdcdc'
set key Left reverse samplen 2.4 spacing 1.15
set xlabel offset 0,0.3

# Each picture in turn: text stays text in the SVG; the PNG has twice as many pixels.
do for [picture in 'svg png'] {{
  if (picture eq 'svg') {{
    set terminal svg size {width},{height} enhanced font 'DejaVu Sans,13' background '#ffffff'
    set title font ',14'
  }} else {{
    set terminal pngcairo size {width2},{height2} enhanced font 'DejaVu Sans,10' fontscale 2 \
        linewidth 2 pointscale 2 dashlength 1.6
    set title font ',11'
  }}
  set output '{name}.'.picture
  set multiplot layout {rows},{columns}
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
  const int height = figure.height > 0 ? figure.height : (figure.rows == 1 ? 460 : 330 * figure.rows);
  std::string script = fmt::format(fmt::runtime(opening), fmt::arg("name", figure.name),
                                   fmt::arg("width", figure.width), fmt::arg("height", height),
                                   fmt::arg("width2", 2 * figure.width), fmt::arg("height2", 2 * height),
                                   fmt::arg("rows", figure.rows), fmt::arg("columns", figure.columns));
  return script + panels_commands(figure) + "\n  unset multiplot\n  unset output\n}\n";
}

}  // namespace beamid::experiments
