#include "experiments/results/gnuplot_curves.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
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

}  // namespace beamid::experiments
