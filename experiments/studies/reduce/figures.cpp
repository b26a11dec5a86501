#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/studies/reduce/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr Colour reduction_colours[] = {Colour::blue,   Colour::vermillion, Colour::green, Colour::purple,
                                        Colour::orange, Colour::sky,        Colour::black, Colour::grey};

Colour colour_of(std::size_t number) {
  return reduction_colours[number % std::size(reduction_colours)];
}

// Filled at first, then open points in the same colours.
CurveStyle points_of(std::size_t number) {
  return number < std::size(reduction_colours) ? CurveStyle::points : CurveStyle::open_points;
}

Curve curve(const std::string& label, const VectorXd& x, const VectorXd& y, Colour colour,
            CurveStyle style = CurveStyle::line) {
  return {label, x, y, style, {}, {}, colour};
}

// One column of points for each mode, a place in it for each reduction. What rounding has left is drawn at
// the bottom.
Figure error_figure(const ReductionComparison& all) {
  constexpr double least = 1e-8;  // [%]
  const auto count = static_cast<double>(all.reductions.size());
  Panel panel{"", {"mode"}, {"|frequency error| [%], 10^{-8} and less as one", true}, {}};
  panel.x_axis.range = {static_cast<double>(all.modes.modes.rigid) + 0.5,
                        static_cast<double>(all.modes.modes.rigid + all.compared()) + 0.5};
  for (std::size_t k = 0; k < all.reductions.size(); ++k) {
    const ComparedReduction& one = all.reductions[k];
    const VectorXd error = one.frequency_error.unaryExpr(
        [least](double e) { return std::isnan(e) ? e : std::max(100.0 * std::abs(e), least); });
    const double first = static_cast<double>(all.modes.modes.rigid) + 1.0 +
                         0.7 * ((static_cast<double>(k) + 0.5) / count - 0.5);
    const VectorXd place =
        VectorXd::NullaryExpr(error.size(), [first](Index i) { return first + static_cast<double>(i); });
    panel.curves.push_back(curve(one.label, place, error, colour_of(k), points_of(k)));
  }
  return {"frequency_error_plot", {panel}, 1, 1, 900, 520};
}

constexpr int columns = 2;

int rows_for(std::size_t panels) {
  return (static_cast<int>(panels) + columns - 1) / columns;
}

// The first panel says what the grey curves are.
std::string title_of(const ComparedReduction& one, const Figure& figure) {
  return one.label + (figure.panels.empty() ? " (grey: mesh)" : "");
}

// A panel for each reduction, the mesh beneath it.
Figure response_figure(const ReductionComparison& all) {
  Figure figure{"response_plot", {}, rows_for(all.reductions.size()), columns, 1000};
  const VectorXd& f = all.frequency_hz;
  for (const ComparedReduction& one : all.reductions) {
    Panel panel{title_of(one, figure),
                {"frequency [Hz]", true, std::pair{f[0], f[f.size() - 1]}},
                {"receptance [m/N]", true},
                {},
                Legend::none};
    panel.curves = {curve("", f, all.behaviour.receptance, Colour::grey),
                    curve("", f, one.behaviour.receptance, Colour::vermillion, CurveStyle::dashed)};
    figure.panels.push_back(std::move(panel));
  }
  figure.height = 240 * figure.rows;
  return figure;
}

// Displacement at the left and acceleration at the right, a row for each reduction: the first four periods.
Figure decay_figure(const ReductionComparison& all) {
  Figure figure{"decay_plot", {}, static_cast<int>(all.reductions.size()), columns, 1000};
  const VectorXd time = all.release.time();
  const double shown = 4.0 / all.mode_hz(0);
  const Index count = (time.array() <= shown).count();
  for (const ComparedReduction& one : all.reductions)
    for (const bool displacement : {true, false}) {
      const double factor = displacement ? 1e3 : 1.0;
      const auto history = [&](const fem::Motion& motion) -> VectorXd {
        return factor * (displacement ? motion.displacement : motion.acceleration).head(count);
      };
      Panel panel{title_of(one, figure),
                  {"time [s]", false, std::pair{0.0, shown}},
                  {displacement ? "displacement [mm]" : "acceleration [m/s^{2}]"},
                  {},
                  Legend::none};
      panel.curves = {curve("", time.head(count), history(all.behaviour.decay), Colour::grey),
                      curve("", time.head(count), history(one.behaviour.decay), Colour::vermillion)};
      figure.panels.push_back(std::move(panel));
    }
  figure.height = 200 * figure.rows;
  return figure;
}

// Deflection at the nodes, largest 1 and there positive, as the first shape has it.
VectorXd drawn(const fem::StructuralSystem& system, const VectorXd& shape) {
  const VectorXd deflection = fem::nodal_deflection(system, shape);
  Index at = 0;
  const double largest = deflection.cwiseAbs().maxCoeff(&at);
  return largest > 0.0 ? VectorXd(deflection / deflection[at]) : deflection;
}

// A panel for each reduction: its modes in colours, those of the mesh beneath them.
Figure shape_figure(const ReductionComparison& all) {
  const Index shown = std::min<Index>(6, all.compared());
  const VectorXd x = all.system.mesh.positions();
  Figure figure{"shape_plot", {}, rows_for(all.reductions.size()), columns, 1000};
  for (const ComparedReduction& one : all.reductions) {
    Panel panel{title_of(one, figure),
                {"x [m]", false, std::pair{0.0, x.maxCoeff()}},
                {"deflection"},
                {},
                Legend::none};
    panel.y_axis.range = {-1.1, 1.1};
    for (Index i = 0; i < shown; ++i) {
      const VectorXd full = drawn(all.system, all.modes.shapes.col(all.modes.modes.rigid + i));
      panel.curves.push_back(curve("", x, full, Colour::grey));
      const Index partner = one.partner[i] + one.modes.modes.rigid;
      if (one.partner[i] < 0 || partner >= one.modes.shapes.cols()) continue;
      VectorXd shape = drawn(all.system, one.modes.shapes.col(partner));
      if (shape.dot(full) < 0.0) shape = -shape;
      panel.curves.push_back(curve("", x, shape, colour_of(static_cast<std::size_t>(i)), CurveStyle::dashed));
    }
    figure.panels.push_back(std::move(panel));
  }
  figure.height = 260 * figure.rows;
  return figure;
}

std::optional<Figure> significance_figure(const ReductionComparison& all) {
  constexpr double least = 1e-16;
  constexpr Index most = 30;
  Panel panel{"", {"number"}, {"share of the first", true}, {}};
  for (std::size_t k = 0; k < all.reductions.size(); ++k) {
    const ComparedReduction& one = all.reductions[k];
    const Index count = std::min(most, one.significance.size());
    if (count == 0 || !(one.significance[0] > 0.0)) continue;
    const VectorXd value = one.significance.head(count) / one.significance[0];
    panel.curves.push_back(curve(
        one.label + ": " + one.significance_name, VectorXd::LinSpaced(count, 1.0, static_cast<double>(count)),
        value.unaryExpr([](double v) { return v > least ? v : std::nan(""); }), colour_of(k), points_of(k)));
  }
  if (panel.curves.empty()) return std::nullopt;
  return Figure{"significance_plot", {panel}, 1, 1, 800, 480};
}

}  // namespace

std::vector<Figure> figures(const ReductionComparison& all) {
  std::vector<Figure> found{error_figure(all), shape_figure(all), response_figure(all)};
  if (all.release.samples > 0) found.push_back(decay_figure(all));
  if (auto significance = significance_figure(all)) found.push_back(std::move(*significance));
  return found;
}

}  // namespace beamid::experiments
