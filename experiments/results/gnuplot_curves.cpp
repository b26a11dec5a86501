#include "experiments/results/gnuplot_curves.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "experiments/results/gnuplot.hpp"
#include "experiments/results/gnuplot_axes.hpp"

namespace beamid::experiments {
namespace {

constexpr std::array colour_names{"",       "blue", "vermillion", "green", "purple",
                                  "orange", "sky",  "black",      "grey"};
// Circle, square, triangle, diamond and triangle down, filled and open.
constexpr std::array filled_marks{7, 5, 9, 13, 11};
constexpr std::array open_marks{6, 4, 8, 12, 10};

// The names of the colours the panel's curves have.
std::vector<std::string> colours_of(const Panel& panel) {
  std::vector<std::string> names;
  std::size_t next = 0;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    if (curve.colour != Colour::automatic) {
      names.emplace_back(colour_names[static_cast<std::size_t>(curve.colour)]);
      continue;
    }
    const bool band = curve.style == CurveStyle::band && i + 1 < panel.curves.size();
    if (band && panel.curves[i + 1].colour != Colour::automatic)
      names.emplace_back(colour_names[static_cast<std::size_t>(panel.curves[i + 1].colour)]);
    else
      names.emplace_back(colour_names[1 + next % 6]);
    if (!band) ++next;
  }
  return names;
}

std::string curve_command(const Panel& panel, const Curve& curve, const std::string& colour, int first,
                          int mark) {
  const std::string title = curve.label.empty() ? "notitle" : "title " + gnuplot_text(curve.label);
  Extent drawn;
  drawn.add(curve.style == CurveStyle::band ? curve.upper : curve.y, panel.y_axis.logarithmic);
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
  const auto line = [&](const char* dashes) {
    return fmt::format("data skip 1 using {}:{} with lines linecolor rgb {} linewidth 1.6{} {}", x, y, colour,
                       dashes, title);
  };
  const auto points = [&](int type, double size, double width) {
    return fmt::format(
        "data skip 1 using {}:{}{} with {} linecolor rgb {} linewidth {} pointtype {} pointsize {} {}", x, y,
        bars ? fmt::format(":{}:{}", lower(y + 1), y + 2) : "", bars ? "yerrorbars" : "points", colour, width,
        type, size, title);
  };
  switch (curve.style) {
    case CurveStyle::line:
      return line("");
    case CurveStyle::dashed:
      return line(" dashtype (9,5)");
    case CurveStyle::dotted:
      return line(" dashtype (2,4)");
    case CurveStyle::points:
      return points(filled_marks[mark % 5], 0.7, 1.0);
    case CurveStyle::open_points:
      return points(open_marks[mark % 5], 1.1, 1.6);
    case CurveStyle::band:
      break;
  }
  return fmt::format(
      "data skip 1 using {}:{}:{} with filledcurves linecolor rgb {} fillstyle transparent solid 0.22 "
      "noborder {}",
      x, lower(y), y + 1, colour, title);
}

}  // namespace

int column_count(const Curve& curve) {
  return 1 + (curve.style == CurveStyle::band ? 0 : 1) + (curve.lower.size() > 0 ? 2 : 0);
}

std::string plot_command(const Panel& panel, int& column) {
  std::string out = "  plot";
  const std::vector<std::string> names = colours_of(panel);
  if (panel.curves.empty()) out += " NaN notitle";
  int filled = 0, open = 0;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const int mark = curve.style == CurveStyle::points        ? filled++
                     : curve.style == CurveStyle::open_points ? open++
                                                              : 0;
    out += (i == 0 ? " " : ", \\\n       ") + curve_command(panel, curve, names[i], column, mark);
    column += column_count(curve);
  }
  return out + '\n';
}

}  // namespace beamid::experiments
