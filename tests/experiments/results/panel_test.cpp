// Panels built by their curves, forest plots, spectra, and where frames and legends stand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>
#include <sstream>

#include "experiments/results/figure.hpp"
#include "experiments/results/forest_plot.hpp"
#include "experiments/results/gnuplot.hpp"
#include "experiments/results/text.hpp"
#include "experiments/results/vtk/drawing.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::panel_test {
namespace {

using Eigen::VectorXd;
using testing::HasSubstr;

TEST(Panel, IsBuiltByItsCurves) {
  const VectorXd x = VectorXd::LinSpaced(5, 0, 4);
  const Panel panel = Panel{"", {"t [s]"}, {"f [Hz]"}}
                          .band("95 %", x, x.array() - 1, x.array() + 1)
                          .line("filter", x, x, Colour::blue)
                          .level("modal", 2.5);
  ASSERT_EQ(panel.curves.size(), 3u);
  EXPECT_EQ(panel.curves[0].style, CurveStyle::band);
  EXPECT_EQ(panel.curves[2].x, Eigen::Vector2d(0, 4));  // as wide as the curves
  EXPECT_EQ(panel.curves[2].y, Eigen::Vector2d(2.5, 2.5));
}

ForestPlot with_outlier() {
  return {"bending stiffness",
          "error [%]",
          {"rayleigh", "1 mode", "2 modes", "3 modes", "mesh"},
          {{"",
            {-2.72, 0.001, -0.002, 0.0, 0.0005},
            {-2.725, -0.002, -0.005, -0.003, -0.0005},
            {-2.715, 0.004, 0.001, 0.003, 0.0015}}},
          ForestReference{"true value", 0.0}};
}

// Oracle: the definition. Four rows within 0.005 share the axis, and the fifth, 500 times farther, does not
// set it.
TEST(ForestPlot, IsNotFlattenedByOneRow) {
  const Panel panel = forest_panel(with_outlier());
  const auto [low, high] = *panel.x_axis.range;
  EXPECT_GT(low, -0.01);
  EXPECT_LT(high, 0.01);
  const Curve& arrow = panel.curves.back();
  EXPECT_EQ(arrow.style, CurveStyle::arrows);
  ASSERT_EQ(arrow.y.size(), 1);
  EXPECT_EQ(arrow.y[0], 1.0);
  EXPECT_EQ(arrow.upper[0], low);
  EXPECT_EQ(panel.remarks[0], "-2.7200 (-2.7250 to -2.7150)");
  EXPECT_EQ(panel.y_axis.names[4], "mesh");
}

TEST(ForestPlot, ShowsTheReferenceHoweverFar) {
  ForestPlot plot = with_outlier();
  plot.reference->value = 5;
  EXPECT_GT(forest_panel(plot).x_axis.range->second, 5);
}

TEST(ForestPlot, NamesItsRowsFromTheTop) {
  Figure figure{"forest", {forest_panel(with_outlier())}};
  const std::string script = gnuplot_script(figure);
  EXPECT_THAT(script, HasSubstr("set ytics (\"rayleigh\" 1, "));
  EXPECT_THAT(script, HasSubstr("set yrange [5.6:0.4]"));
  TemporaryFolder folder;
  write(figure, folder.path);
  EXPECT_THAT(contents(folder.path / "forest.svg"), HasSubstr("-2.7200 (-2.7250 to -2.7150)"));
}

// Oracle: the sine. Far from its line the Hann window leaves less than the drawing shows, and the data say
// so.
TEST(SpectrumPanel, HoldsTrueValuesBelowWhatItDraws) {
  const VectorXd t = VectorXd::LinSpaced(4000, 0, 3.999);
  const VectorXd wave = (2 * std::numbers::pi * 50 * t.array()).sin();
  const Panel panel = spectrum_panel({{"", wave}}, 0.001, "acceleration [m/s2]", 3).value();
  const double floor = panel.y_axis.range->first, peak = panel.curves[0].y.maxCoeff();
  EXPECT_NEAR(floor, 1e-3 * peak, 1e-12);
  EXPECT_LT(panel.curves[0].y.minCoeff(), 0.01 * floor);
  EXPECT_GT(panel.curves[0].x[0], 0.0);
  EXPECT_FALSE(spectrum_panel({{"", VectorXd::Ones(100)}}, 0.001, "acceleration [m/s2]"));
}

TEST(ReproductionPanel, HasTheRecordInFront) {
  const VectorXd t = VectorXd::LinSpaced(9, 0, 1);
  const Panel panel = reproduction_panel("", t, t, {{"reproduced", t, Colour::sky}}, "x [m]");
  EXPECT_EQ(panel.curves.back().label, "measured");
  EXPECT_EQ(panel.curves.back().style, CurveStyle::thin);
}

Figure two_rows(const std::string& second_unit) {
  const VectorXd x = VectorXd::LinSpaced(9, 0, 1);
  Figure figure{"rows", {}, 2, 1};
  figure.panels = {Panel{"", {"t [s]"}, {"f [Hz]"}}.line("filter", x, 1e-5 * x).line("modal", x, x),
                   Panel{"", {"t [s]"}, {second_unit}}.line("filter", x, x)};
  return figure;
}

TEST(Layout, GivesFramesOneHeightAndOneLeftEdge) {
  const Figure figure = two_rows("K [N/m]");
  const auto places = panel_places(figure, 660);
  EXPECT_EQ(places[0].left, places[1].left);
  EXPECT_NEAR(places[0].bottom - places[0].top, places[1].bottom - places[1].top, 1e-9);
}

TEST(Layout, SaysACommonLegendOnceBelowAllFrames) {
  const auto places = panel_places(two_rows("K [N/m]"), 660);
  EXPECT_EQ(places[0].legend_columns, 2);
  EXPECT_EQ(places[1].legend_columns, 0);
  EXPECT_GT(places[0].legend_y, places[1].bottom + 40);  // below ticks and label of the last frame
  EXPECT_LT(places[0].legend_y, 660 - 20);
}

// Oracle: the SVG that gnuplot draws. Its legend stands below its axis label.
TEST(Layout, KeepsLegendAndAxisLabelApart) {
  TemporaryFolder folder;
  write(two_rows("K [N/m]"), folder.path);
  const std::string svg = contents(folder.path / "rows.svg");
  const auto height_of = [&](const std::string& text) {
    const std::size_t at = svg.rfind(">" + text + "<");
    EXPECT_NE(at, std::string::npos) << text;
    const std::size_t moved = svg.rfind("translate(", at);
    return std::stod(svg.substr(svg.find(',', moved) + 1));
  };
  const auto printed = [](std::string text) {  // gnuplot's blanks do not break
    for (std::size_t at; (at = text.find(' ')) != std::string::npos;) text.replace(at, 1, "\u00a0");
    return text;
  };
  const std::string label = svg.find(">t [s]<") != std::string::npos ? "t [s]" : printed("t [s]");
  EXPECT_GT(height_of("modal"), height_of(label) + 12);
}

TEST(Layout, GivesOneLabelOneColour) {
  const VectorXd x = VectorXd::LinSpaced(9, 0, 1);
  Figure figure{"colours", {}, 2, 1};
  figure.panels = {Panel{"", {"a"}, {"b"}}.line("one", x, x).line("two", x, x),
                   Panel{"", {"a"}, {"b"}}.line("two", x, x)};
  const std::string script = gnuplot_script(figure);
  const std::regex two("lines linecolor rgb (\\w+) linewidth 1.6 title \"two\"");
  std::vector<std::string> colours;
  for (std::sregex_iterator at(script.begin(), script.end(), two), end; at != end; ++at)
    colours.push_back((*at)[1]);
  EXPECT_EQ(colours, (std::vector<std::string>{"vermillion", "vermillion"}));
}

// Oracle: the labels' widths. Numbers of five characters every 30 px would overlap.
TEST(Ticks, StandClearOfEachOther) {
  EXPECT_THAT(logarithmic_ticks('x', {0.001, 0.1}, 340).commands,
              HasSubstr("set xtics (0.001, 0.003, 0.01, 0.03, 0.1)"));
  EXPECT_THAT(logarithmic_ticks('x', {0.001, 0.1}, 900).commands, HasSubstr("0.002, 0.005"));
  EXPECT_EQ(step_for({-50, 40}, 80, true), 50);
  EXPECT_EQ(step_for({-1.3, 1.3}, 60, true), 1);  // 2 would leave the 0 alone
  EXPECT_EQ(rounded_up_step(0.012), 0.02);
}

}  // namespace
}  // namespace beamid::experiments::panel_test
