#include "experiments/results/gnuplot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/gnuplot_curves.hpp"
#include "experiments/results/gnuplot_layout.hpp"
#include "experiments/results/gnuplot_ticks.hpp"
#include "experiments/results/text.hpp"
#include "experiments/results/typeset.hpp"
#include "experiments/text/clean_text.hpp"

namespace beamid::experiments {
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

# Colours that colour-blind readers tell apart (Okabe and Ito).
blue = '#0072b2'; vermillion = '#d55e00'; green = '#009e73'; purple = '#cc79a7'; orange = '#e69f00'
sky = '#56b4e9'; black = '#000000'; grey = '#7f7f7f'

# Frame, ticks, grid and legend of every panel.
set border 3 linewidth 0.8 linecolor rgb '#404040'
set tics out nomirror scale 0.7,0.4
set grid back linetype 1 linewidth 0.5 linecolor rgb '#dcdcdc'
set key Left reverse samplen 2.4 spacing 1.15

# Each picture in turn: text stays text in the SVG; the PNG has twice as many pixels.
do for [picture in 'svg png'] {{
  if (picture eq 'svg') {{
    set terminal svg size {width},{height} enhanced font 'DejaVu Sans,13' background '#ffffff'
    set title font ',14' offset 0,-0.4; set xlabel offset 0,0.75
    set xtics offset 0,0.35
  }} else {{
    set terminal pngcairo size {width2},{height2} enhanced font 'DejaVu Sans,10' fontscale 2 \
        linewidth 2 pointscale 2 dashlength 1.6
    set title font ',11'; set xlabel offset 0,0.3; set xtics offset 0,0
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
