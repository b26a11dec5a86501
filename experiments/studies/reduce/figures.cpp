#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/results/mode_figure.hpp"
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

/// How many of the compared modes any of the reductions has.
Index modes_with_partner(const ReductionComparison& all) {
  Index last = 0;
  for (const ComparedReduction& one : all.reductions)
    for (Index i = 0; i < all.compared(); ++i)
      if (one.partner[static_cast<std::size_t>(i)] >= 0) last = std::max(last, i + 1);
  return std::max<Index>(last, 1);
}

// One column of points for each mode, a place in it for each reduction. What rounding has left is drawn at
// the bottom.
Figure error_figure(const ReductionComparison& all) {
  constexpr double least = 1e-8;  // [%]
  const auto count = static_cast<double>(all.reductions.size());
  const auto rigid = static_cast<double>(all.modes.modes.rigid);
  Panel panel{"", {"mode"}, {"|frequency error| [%] (floor 10^{-8})", true}};
  panel.across(rigid + 0.5, rigid + static_cast<double>(modes_with_partner(all)) + 0.5);
  panel.x_axis.tick = 1;
  for (std::size_t k = 0; k < all.reductions.size(); ++k) {
    const ComparedReduction& one = all.reductions[k];
    const VectorXd error = one.frequency_error.unaryExpr(
        [least](double e) { return std::isnan(e) ? e : std::max(100.0 * std::abs(e), least); });
    const double first = rigid + 1.0 + 0.7 * ((static_cast<double>(k) + 0.5) / count - 0.5);
    const VectorXd place =
        VectorXd::NullaryExpr(error.size(), [first](Index i) { return first + static_cast<double>(i); });
    panel.add(points_of(k), one.label, place, error, colour_of(k));
  }
  Figure figure{"frequency_error_plot", {panel}, 1, 1, 900, 520};
  figure.caption =
      "Frequency errors of the reductions against the mesh; a mode that a reduction lacks has no point.";
  return figure;
}

constexpr int columns = 2;

int rows_for(std::size_t panels) {
  return (static_cast<int>(panels) + columns - 1) / columns;
}

// A panel for each reduction, the mesh beneath it.
Figure response_figure(const ReductionComparison& all) {
  Figure figure{"response_plot", {}, rows_for(all.reductions.size()), columns, 1000};
  const VectorXd& f = all.frequency_hz;
  for (const ComparedReduction& one : all.reductions)
    figure.panels.push_back(Panel{one.label, {"frequency [Hz]", true}, {"receptance [m/N]", true}}
                                .across(f[0], f[f.size() - 1])
                                .line("mesh", f, all.behaviour.receptance, Colour::grey)
                                .dashed("reduced", f, one.behaviour.receptance, Colour::vermillion));
  figure.height = 40 + 240 * figure.rows;
  figure.caption = "Receptance of each reduction and of the mesh.";
  return figure;
}

// The mesh's motion in the first row, and what each reduction makes of it wrong below: displacement at the
// left and acceleration at the right, the first four periods.
Figure decay_figure(const ReductionComparison& all) {
  Figure figure{"decay_plot", {}, 1 + static_cast<int>(all.reductions.size()), columns, 1000};
  const VectorXd time = all.release.time();
  const double shown = 4.0 / all.mode_hz(0);
  const Index count = (time.array() <= shown).count();
  const auto row = [&](const std::string& title, const ModelBehaviour* reduced) {
    for (const bool displacement : {true, false}) {
      const double factor = displacement ? 1e3 : 1.0;
      const auto history = [&](const fem::Motion& motion) -> VectorXd {
        return factor * (displacement ? motion.displacement : motion.acceleration).head(count);
      };
      const std::string unit = displacement ? "[mm]" : "[m/s2]";
      const VectorXd mesh = history(all.behaviour.decay);
      const VectorXd drawn = reduced ? VectorXd(history(reduced->decay) - mesh) : mesh;
      figure.panels.push_back(
          Panel{title,
                {""},
                {(reduced        ? "error "
                  : displacement ? "displacement "
                                 : "acceleration ") +
                 unit}}
              .across(0.0, shown)
              .thin("", time.head(count), drawn, reduced ? Colour::vermillion : Colour::black)
              .key(Legend::none));
    }
  };
  row("the mesh", nullptr);
  for (const ComparedReduction& one : all.reductions) row(one.label, &one.behaviour);
  for (std::size_t i = figure.panels.size() - columns; i < figure.panels.size(); ++i)
    figure.panels[i].x_axis.label = "time [s]";
  figure.height = 40 + 150 * figure.rows;
  figure.caption =
      "Release of the mesh (first row) and the error of each reduction: displacement left, acceleration "
      "right.";
  return figure;
}

// A panel for each reduction: its modes in colours, those of the mesh beneath them.
Figure shape_figure(const ReductionComparison& all) {
  const Index shown = std::min<Index>(6, modes_with_partner(all));
  const double length = all.system.mesh.positions().maxCoeff();
  Figure figure{"shape_plot", {}, rows_for(all.reductions.size()), columns, 1000};
  for (const ComparedReduction& one : all.reductions) {
    Panel panel{one.label, {"x [m]"}, {"deflection (largest 1)"}};
    panel.across(0.0, length).up(-1.1, 1.1);
    for (Index i = 0; i < shown; ++i) {
      const Curve full = mode_curve(all.system, all.modes.shapes.col(all.modes.modes.rigid + i));
      panel.line(i == 0 ? "mesh" : "", full.x, full.y, Colour::grey);
      const Index partner = one.partner[static_cast<std::size_t>(i)] + one.modes.modes.rigid;
      if (one.partner[static_cast<std::size_t>(i)] < 0 || partner >= one.modes.shapes.cols()) continue;
      const Curve shape = mode_curve(all.system, one.modes.shapes.col(partner));
      const double sign = shape.y.dot(full.y) < 0.0 ? -1.0 : 1.0;
      panel.dashed(fmt::format("mode {}", i + 1), shape.x, sign * shape.y,
                   colour_of(static_cast<std::size_t>(i)));
    }
    figure.panels.push_back(std::move(panel));
  }
  figure.height = 40 + 260 * figure.rows;
  figure.caption = "Mode shapes of each reduction (dashed) over those of the mesh (grey).";
  return figure;
}

std::optional<Figure> significance_figure(const ReductionComparison& all) {
  constexpr double least = 1e-16;
  constexpr Index most = 30;
  Panel panel{"", {"number"}, {"share of the first", true}};
  for (std::size_t k = 0; k < all.reductions.size(); ++k) {
    const ComparedReduction& one = all.reductions[k];
    const Index count = std::min(most, one.significance.size());
    if (count == 0 || !(one.significance[0] > 0.0)) continue;
    const VectorXd value = one.significance.head(count) / one.significance[0];
    panel.add(points_of(k), one.label + ": " + one.significance_name,
              VectorXd::LinSpaced(count, 1.0, static_cast<double>(count)),
              value.unaryExpr([](double v) { return v > least ? v : std::nan(""); }), colour_of(k));
  }
  if (panel.curves.empty()) return std::nullopt;
  return Figure{"significance_plot", {panel}, 1, 1, 800, 480};
}

}  // namespace

SwingModel paired_modes(const fem::Structure& structure, const ReductionComparison& all) {
  std::vector<VectorXd> shapes;
  std::vector<double> frequencies;
  std::vector<std::string> names;
  std::vector<std::optional<int>> beside;  // of a partner the mode of the mesh
  const auto add = [&](const VectorXd& shape, double frequency_hz, const std::string& name) {
    shapes.push_back(shape);
    frequencies.push_back(frequency_hz);
    names.push_back(name);
    beside.emplace_back();
  };
  const Index rigid = all.modes.modes.rigid, each = 1 + static_cast<Index>(all.reductions.size());
  const Index shown = std::clamp<Index>(most_drawn_modes / each, 1, modes_with_partner(all));
  for (Index i = 0; i < shown; ++i) {
    add(all.modes.shapes.col(rigid + i), all.mode_hz(i),
        fmt::format("mode {}, {:.5g} Hz", i + 1, all.mode_hz(i)));
    const auto of_mesh = static_cast<int>(names.size()) - 1;
    for (const ComparedReduction& one : all.reductions) {
      const Index partner = one.partner[static_cast<std::size_t>(i)] + one.modes.modes.rigid;
      if (one.partner[static_cast<std::size_t>(i)] < 0 || partner >= one.modes.shapes.cols()) continue;
      if (one.identity || static_cast<Index>(names.size()) == most_drawn_modes) continue;
      add(one.modes.shapes.col(partner), one.frequency_hz[i],
          fmt::format("mode {} of {}, {:.5g} Hz, MAC {:.4f}", i + 1, one.label, one.frequency_hz[i],
                      one.mac[i]));
      beside.back() = of_mesh;
    }
  }
  Eigen::MatrixXd matrix(all.system.size(), static_cast<Index>(shapes.size()));
  for (std::size_t k = 0; k < shapes.size(); ++k) matrix.col(static_cast<Index>(k)) = shapes[k];
  const VectorXd frequency_hz = Eigen::Map<const VectorXd>(frequencies.data(), matrix.cols());
  SwingModel model = mode_model(Picture(structure, all.system), matrix, frequency_hz);
  for (std::size_t k = 0; k < names.size(); ++k)
    model.modes[k].name = names[k], model.modes[k].beside = beside[k];
  return model;
}

std::vector<Figure> figures(const ReductionComparison& all) {
  std::vector<Figure> found{error_figure(all)};
  if (!all.system.mesh.nodes.empty()) found.push_back(shape_figure(all));
  found.push_back(response_figure(all));
  if (all.release.samples > 0) found.push_back(decay_figure(all));
  if (auto significance = significance_figure(all)) found.push_back(std::move(*significance));
  return found;
}

}  // namespace beamid::experiments
